// Files that appear under their names only when all of them are complete.
#pragma once

#include <cstdio>
#include <functional>
#include <list>
#include <string>
#include <vector>

namespace raycell {

/// The words for an error number of the C library.
std::string reason_of(int error);

/// Throws std::runtime_error "can't WHAT PATH: WHY".
[[noreturn]] void fail(const char* what, const std::string& path, const std::string& why);

/// Whether both paths name the same file, or would if it were made now.
bool same_file(const std::string& a, const std::string& b);

/// A file that is written under a temporary name in its folder. Unless it is published, it is removed when
/// the object or the program ends; an older file stays until then. All members throw std::runtime_error
/// naming file and reason.
class NewFile {
  public:
    /// Throws for a path that exists and is not a regular file.
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    std::FILE* stream() { return file_; }
    const std::string& path() const { return path_; }
    /// Its temporary name, until it is published.
    const std::string& partial() const { return partial_; }
    void write(const std::string& text) { std::fwrite(text.data(), 1, text.size(), file_); }

    /// Ends writing. An error of an earlier write is thrown here at the latest.
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

/// The files of one run. publish() gives all of them their names at once, with signals held back. Without it,
/// or if it throws, no file appears and an earlier set is unchanged.
class OutputSet {
  public:
    explicit OutputSet(std::string prefix) : prefix_(std::move(prefix)) {}
    ~OutputSet();
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;

    /// Announces PREFIX + each suffix and throws std::runtime_error if one can't be written. Leaves nothing
    /// behind.
    void announce(const std::vector<std::string>& suffixes);
    /// The same for a file of any name.
    void announce_file(const std::string& path);
    /// All announced paths.
    const std::vector<std::string>& announced() const { return announced_; }

    /// The temporary name of a file that was begun, until publish().
    const std::string& partial(const std::string& path) const;

    /// Begins PREFIX + suffix, which must have been announced. It may be written until publish().
    NewFile& begin(const std::string& suffix);
    NewFile& begin_file(const std::string& path);
    /// Begins a file, lets `writer` write it, and closes it.
    void write(const std::string& suffix, const std::function<void(NewFile&)>& writer);
    void write(const std::string& suffix, const std::string& text);
    /// The same for an optional text. If it is not `there`, publish() removes a file of this name that an
    /// earlier run left, so that it is not taken for this run's.
    void write_if(bool there, const std::string& suffix, const std::function<std::string()>& text);
    /// Takes over a finished file, which must be in the same file system.
    void adopt(const std::string& suffix, const std::string& path);

    void publish();

  private:
    void make_folder(const std::string& path);

    std::string prefix_;
    std::vector<std::string> made_;  ///< folders that were not there, outermost first
    std::vector<std::string> announced_;
    std::list<NewFile> files_;
    std::vector<std::string> outdated_;
};

}  // namespace raycell
