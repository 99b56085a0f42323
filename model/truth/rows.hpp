// Spreads the rows of a picture over threads.
#pragma once

#include <functional>

namespace raycell {

/// Calls work(row) once for each row in [0, rows), from `threads` threads (0: as many as the processor has).
/// `progress(done, rows)` is called after each row, by one thread at a time. The first exception that a row
/// or `progress` throws stops the others and is rethrown.
void for_each_row(int rows, int threads, const std::function<void(int, int)>& progress,
                  const std::function<void(int)>& work);

}  // namespace raycell
