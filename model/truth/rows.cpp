#include "model/truth/rows.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace raycell {

void for_each_row(int rows, int threads, const std::function<void(int, int)>& progress,
                  const std::function<void(int)>& work) {
    std::atomic<int> next{0};
    std::mutex mutex;
    int done = 0;
    std::exception_ptr failure;

    const auto run = [&] {
        try {
            for (int row = next++; row < rows; row = next++) {
                work(row);
                const std::lock_guard<std::mutex> lock(mutex);
                ++done;
                if (progress) progress(done, rows);
            }
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex);
            if (!failure) failure = std::current_exception();
            next = rows;
        }
    };

    if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::thread> helpers;
    helpers.reserve(std::size_t(std::max(0, std::min(threads, rows) - 1)));
    for (int i = 1; i < std::min(threads, rows); ++i) {
        try {
            helpers.emplace_back(run);
        } catch (const std::exception&) {
            break;  // no more threads, or no memory for them: the existing ones do the work
        }
    }
    run();
    for (std::thread& helper : helpers) helper.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace raycell
