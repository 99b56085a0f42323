// Files that come to be under their names only when all of them are whole.
#pragma once

#include <cstdio>
#include <functional>
#include <list>
#include <string>
#include <vector>

namespace raycell {

/// What went wrong with the C library's last call, in words.
std::string reason_of(int error);

/// Throws std::runtime_error "can't WHAT PATH: WHY".
[[noreturn]] void fail(const char* what, const std::string& path, const std::string& why);

/// Whether both names lead to one file, or would if they were made now.
bool same_file(const std::string& a, const std::string& b);

/// A file under another name in the same folder, removed at the end of its life or of the program, unless it
/// is published; an older file stays until then. All members throw std::runtime_error naming file and reason.
class NewFile {
  public:
    /// Refuses a path that is there and no regular file.
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    std::FILE* stream() { return file_; }
    const std::string& path() const { return path_; }
    /// What it is called until it is published.
    const std::string& partial() const { return partial_; }
    void write(const std::string& text) { std::fwrite(text.data(), 1, text.size(), file_); }

    /// Nothing more is written. What went wrong in writing comes to light here at the latest.
    void close();
    /// Closes it and gives it its name.
    void publish();

  private:
    friend class Exchange;
    std::string path_;
    std::string partial_;
    std::FILE* file_ = nullptr;
    bool published_ = false;
};

/// Writes a text file whole or not at all.
void write_text(const std::string& path, const std::string& text);

/// The files of one run. publish() gives all of them their names at once, with signals held back; without it,
/// or if it throws, there are none, and an earlier set is as it was.
class OutputSet {
  public:
    explicit OutputSet(std::string prefix) : prefix_(std::move(prefix)) {}

    /// Announces PREFIX + each suffix, and finds out whether they can be written: throws std::runtime_error
    /// otherwise. Leaves nothing behind.
    void announce(const std::vector<std::string>& suffixes);
    /// The same for a file of any name.
    void announce_file(const std::string& path);
    /// All that were announced.
    const std::vector<std::string>& announced() const { return announced_; }

    /// What a file that was begun is called until publish().
    const std::string& partial(const std::string& path) const;

    /// Begins PREFIX + suffix, which must have been announced, to be written until publish().
    NewFile& begin(const std::string& suffix);
    NewFile& begin_file(const std::string& path);
    /// Begins it, has it written, and closes it.
    void write(const std::string& suffix, const std::function<void(NewFile&)>& writer);
    void write(const std::string& suffix, const std::string& text);
    /// The same for a text that there may be or not: without it, a file that an earlier run left under this
    /// name is removed by publish(), so that it is not taken for this run's.
    void write_if(bool there, const std::string& suffix, const std::function<std::string()>& text);
    /// Takes over a file of the same file system.
    void adopt(const std::string& suffix, const std::string& path);

    void publish();

  private:
    std::string prefix_;
    std::vector<std::string> announced_;
    std::list<NewFile> files_;
    std::vector<std::string> outdated_;
};

}  // namespace raycell
