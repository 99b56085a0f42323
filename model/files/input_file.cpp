#include "model/files/input_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace raycell {

std::string input_fault(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) return "no such file";
    if (error) return "can't be opened: " + error.message();
    if (std::filesystem::is_directory(status)) return "is a directory";
    if (!std::filesystem::is_regular_file(status)) return "is a device, pipe or socket";
    if (eaccess(path.c_str(), R_OK) != 0) return std::string("can't be opened: ") + std::strerror(errno);
    return "";
}

}  // namespace raycell
