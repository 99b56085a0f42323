#include "testbench/raycell/new_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace raycell {

namespace fs = std::filesystem;

std::string reason_of(int error) { return std::strerror(error); }

[[noreturn]] void fail(const char* what, const std::string& path, const std::string& why) {
    throw std::runtime_error(std::string("can't ") + what + " " + path + ": " + why);
}

NewFile::NewFile(const std::string& path) : path_(path), partial_(path + ".part" + std::to_string(getpid())) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        fail("write", path, "it exists and is not a regular file");
    }
    file_ = std::fopen(partial_.c_str(), "wb");
    if (!file_) fail("write", path, reason_of(errno));
}

NewFile::~NewFile() {
    if (file_) std::fclose(file_);
    if (!partial_.empty()) std::remove(partial_.c_str());
}

void NewFile::finish() {
    const bool written = std::fflush(file_) == 0 && !std::ferror(file_);
    const int error = errno;
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    if (!written || !closed) fail("write", path_, reason_of(written ? errno : error));
    if (std::rename(partial_.c_str(), path_.c_str()) != 0) fail("write", path_, reason_of(errno));
    partial_.clear();
}

void write_text(const std::string& path, const std::string& text) {
    NewFile file(path);
    std::fwrite(text.data(), 1, text.size(), file.stream());
    file.finish();
}

void OutputSet::write(const std::string& suffix, const std::function<void(const std::string&)>& writer) {
    writer(prefix_ + suffix);
    paths_.push_back(prefix_ + suffix);
}

void OutputSet::write_if(bool there, const std::string& suffix, const std::function<std::string()>& text) {
    if (there) {
        write(suffix, [&](const std::string& path) { write_text(path, text()); });
    } else {
        outdated_.push_back(prefix_ + suffix);
    }
}

void OutputSet::keep() {
    paths_.clear();
    for (const std::string& path : outdated_) std::remove(path.c_str());
    outdated_.clear();
}

OutputSet::~OutputSet() {
    for (const std::string& path : paths_) std::remove(path.c_str());
}

}  // namespace raycell
