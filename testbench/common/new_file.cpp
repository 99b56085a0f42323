#include "testbench/common/new_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "testbench/common/signals.hpp"

namespace raycell {

namespace fs = std::filesystem;

std::string reason_of(int error) { return std::strerror(error); }

[[noreturn]] void fail(const char* what, const std::string& path, const std::string& why) {
    throw std::runtime_error(std::string("can't ") + what + " " + path + ": " + why);
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    const auto path_a = fs::weakly_canonical(a, error);
    const auto path_b = fs::weakly_canonical(b, error);
    return !error && path_a == path_b;
}

namespace {

void refuse_unless_regular(const std::string& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        fail("write", path, "it exists and is not a regular file");
    }
}

void rename_file(const std::string& from, const std::string& to, const std::string& named) {
    if (std::rename(from.c_str(), to.c_str()) != 0) fail("write", named, reason_of(errno));
}

std::string partial_name(const std::string& path) { return path + ".part" + std::to_string(getpid()); }

}  // namespace

NewFile::NewFile(const std::string& path) : path_(path), partial_(partial_name(path)) {
    refuse_unless_regular(path);
    add_unfinished(partial_.c_str());
    file_ = std::fopen(partial_.c_str(), "wb");
    if (file_) return;
    const int error = errno;
    drop_unfinished(partial_.c_str());
    fail("write", path, reason_of(error));
}

NewFile::~NewFile() {
    if (file_) std::fclose(file_);
    if (!published_) std::remove(partial_.c_str());
    drop_unfinished(partial_.c_str());
}

void NewFile::close() {
    if (!file_) return;
    errno = 0;
    bool written = std::fflush(file_) == 0;
    if (written && std::ferror(file_)) {
        // An earlier write failed and its reason is lost. One more byte fails for the same reason.
        written = false;
        std::fputc(0, file_);
        std::fflush(file_);
    }
    const int error = errno != 0 ? errno : EIO;
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    if (!written || !closed) fail("write", path_, reason_of(written ? errno : error));
}

/// Renames files; the destructor undoes all renames unless keep() was called.
class Exchange {
  public:
    ~Exchange() {
        for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
            if (step->placed) std::rename(step->path.c_str(), step->placed->partial_.c_str());
            if (!step->old.empty()) std::rename(step->old.c_str(), step->path.c_str());
        }
    }

    /// Renames a file out of the way, if it exists.
    void take_away(const std::string& path) {
        refuse_unless_regular(path);
        std::string old = path + ".old" + std::to_string(getpid());
        steps_.push_back({path, "", nullptr});
        struct stat there {};
        if (lstat(path.c_str(), &there) != 0) return;
        rename_file(path, old, path);
        steps_.back().old = std::move(old);
    }

    void place(NewFile& file) {
        take_away(file.path_);
        rename_file(file.partial_, file.path_, file.path_);
        steps_.back().placed = &file;
    }

    void keep() {
        for (Step& step : steps_) {
            if (!step.old.empty()) std::remove(step.old.c_str());
            if (step.placed) step.placed->published_ = true;
        }
        steps_.clear();
    }

  private:
    struct Step {
        std::string path;
        std::string old;  ///< temporary name of the earlier file; empty: there was none
        NewFile* placed;  ///< null: no new file is at this path
    };
    std::vector<Step> steps_;
};

void NewFile::publish() {
    close();
    const HeldSignals hold;
    Exchange exchange;
    exchange.place(*this);
    exchange.keep();
}

void write_text(const std::string& path, const std::string& text) {
    NewFile file(path);
    file.write(text);
    file.publish();
}

OutputSet::~OutputSet() {
    files_.clear();
    std::error_code ignored;  // of folders that hold something
    for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder)
        std::filesystem::remove(*folder, ignored);
}

void OutputSet::make_folder(const std::string& path) {
    std::vector<std::filesystem::path> missing;
    for (auto folder = std::filesystem::path(path).parent_path();
         !folder.empty() && !std::filesystem::exists(folder); folder = folder.parent_path())
        missing.push_back(folder);
    for (auto folder = missing.rbegin(); folder != missing.rend(); ++folder) {
        std::filesystem::create_directory(*folder);
        made_.push_back(folder->string());
    }
}

void OutputSet::announce_file(const std::string& path) {
    make_folder(path);
    const NewFile tried(path);
    announced_.push_back(path);
}

void OutputSet::announce(const std::vector<std::string>& suffixes) {
    for (const std::string& suffix : suffixes) announce_file(prefix_ + suffix);
}

NewFile& OutputSet::begin_file(const std::string& path) {
    if (std::find(announced_.begin(), announced_.end(), path) == announced_.end())
        throw std::logic_error("internal error: " + path + " was not announced");
    return files_.emplace_back(path);
}

const std::string& OutputSet::partial(const std::string& path) const {
    const auto begun =
        std::find_if(files_.begin(), files_.end(), [&](const NewFile& file) { return file.path() == path; });
    if (begun == files_.end()) throw std::logic_error("internal error: " + path + " was not begun");
    return begun->partial();
}

NewFile& OutputSet::begin(const std::string& suffix) { return begin_file(prefix_ + suffix); }

void OutputSet::write(const std::string& suffix, const std::function<void(NewFile&)>& writer) {
    NewFile& file = begin(suffix);
    writer(file);
    file.close();
}

void OutputSet::write(const std::string& suffix, const std::string& text) {
    write(suffix, [&](NewFile& file) { file.write(text); });
}

void OutputSet::write_if(bool there, const std::string& suffix, const std::function<std::string()>& text) {
    if (there) {
        write(suffix, text());
    } else {
        outdated_.push_back(prefix_ + suffix);
    }
}

void OutputSet::adopt(const std::string& suffix, const std::string& path) {
    NewFile& file = begin(suffix);
    file.close();
    rename_file(path, file.partial(), file.path());
}

void OutputSet::publish() {
    for (NewFile& file : files_) file.close();
    const HeldSignals hold;
    Exchange exchange;
    for (const std::string& path : outdated_) exchange.take_away(path);
    for (NewFile& file : files_) exchange.place(file);
    exchange.keep();
    note_published();
    files_.clear();
    outdated_.clear();
}

}  // namespace raycell
