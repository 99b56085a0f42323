// Files that come to be under their names only when they are whole.
#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace raycell {

/// What went wrong with the C library's last call, in words.
std::string reason_of(int error);

/// Throws std::runtime_error "can't WHAT PATH: WHY".
[[noreturn]] void fail(const char* what, const std::string& path, const std::string& why);

/// Writes under another name in the same folder and renames at the end; an older file stays until then. All
/// members throw std::runtime_error naming file and reason.
class NewFile {
  public:
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    std::FILE* stream() { return file_; }
    const std::string& path() const { return path_; }

    /// Gives the file its name. Whatever went wrong in writing comes to light here at the latest.
    void finish();

  private:
    std::string path_;
    std::string partial_;
    std::FILE* file_ = nullptr;
};

/// Writes a text file whole or not at all.
void write_text(const std::string& path, const std::string& text);

/// The files of one run: all of them, or, if the run fails before keep(), none.
class OutputSet {
  public:
    explicit OutputSet(std::string prefix) : prefix_(std::move(prefix)) {}
    ~OutputSet();
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;

    /// Has PREFIX + suffix written, and remembers it once it is there.
    void write(const std::string& suffix, const std::function<void(const std::string& path)>& writer);
    /// The same for a text that there may be or not: without it, a file that an earlier run left under this
    /// name is removed by keep(), so that it is not taken for this run's.
    void write_if(bool there, const std::string& suffix, const std::function<std::string()>& text);
    void keep();

  private:
    std::string prefix_;
    std::vector<std::string> paths_;
    std::vector<std::string> outdated_;
};

}  // namespace raycell
