// What a program may open to read.
#pragma once

#include <filesystem>
#include <string>

namespace raycell {

/// What stands against reading this path as a file ("no such file", "is a directory", "is a device, pipe or
/// socket", or what the system says); empty if nothing does. Nothing is opened: to open a pipe would wait for
/// its writer, and to read a device might never end.
std::string input_fault(const std::filesystem::path& path);

}  // namespace raycell
