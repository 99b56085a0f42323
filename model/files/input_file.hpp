// Checks an input path before it is opened.
#pragma once

#include <filesystem>
#include <string>

namespace raycell {

/// Why this path can't be read as a file ("no such file", "is a directory", "is a device, pipe or socket", or
/// the system's message); empty if it can. Opens nothing: opening a pipe would wait for its writer, and
/// reading a device might never end.
std::string input_fault(const std::filesystem::path& path);

}  // namespace raycell
