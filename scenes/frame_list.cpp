#include "scenes/frame_list.hpp"

#include "scenes/nff_reader.hpp"
#include "scenes/text_source.hpp"

namespace raycell {
namespace {

const char* const words_of_a_frame = "from x y z, at x y z, up x y z, angle degrees, scene FILE";

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Reads one line from left to right.
class LineReader {
  public:
    LineReader(std::string text, const std::filesystem::path& list, std::size_t line)
        : text_(std::move(text)), list_(list) {
        text_.resize(std::min(text_.find('#'), text_.size()));
        while (!text_.empty() && is_blank(text_.back())) text_.pop_back();
        frame_.line = line;
    }

    bool empty() {
        skip_blanks();
        return at_ == text_.size();
    }

    FrameLine read() {
        while (!empty()) take(word());
        return std::move(frame_);
    }

  private:
    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        throw InputError(printable_path(list_), frame_.line, what, expected);
    }

    void skip_blanks() {
        while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    }

    std::string word() {
        skip_blanks();
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }

    void take(const std::string& name) {
        if (name == "from") return set(frame_.from, name, [&] { return point(name); });
        if (name == "at") return set(frame_.at, name, [&] { return point(name); });
        if (name == "up") return set(frame_.up, name, [&] { return point(name); });
        if (name == "angle") return set(frame_.angle, name, [&] { return number(name); });
        if (name != "scene") fail("unknown word '" + printable(name) + "'", words_of_a_frame);
        skip_blanks();
        if (at_ == text_.size()) fail("'scene' has no file", "scene FILE");
        frame_.scene = list_.parent_path() / text_.substr(at_);
        at_ = text_.size();
    }

    template <typename T, typename Read>
    void set(std::optional<T>& value, const std::string& name, const Read& read) {
        if (value) fail("'" + name + "' comes twice", "it once");
        value = read();
    }

    double number(const std::string& name) {
        const std::string text = word();
        double value = 0;
        const NumberFault fault = parse_number(text, value);
        if (fault != NumberFault::none) {
            fail("'" + name + "' is followed by '" + printable(text) + "'",
                 name == "angle" ? "a number, degrees" : "three numbers x y z");
        }
        return value;
    }

    dvec3 point(const std::string& name) {
        const double x = number(name), y = number(name), z = number(name);
        return {x, y, z};
    }

    std::string text_;
    const std::filesystem::path& list_;
    std::size_t at_ = 0;
    FrameLine frame_;
};

}  // namespace

std::vector<FrameLine> read_frame_list(const std::filesystem::path& path) {
    TextSource source(path);
    std::vector<FrameLine> frames;
    for (int c = 0; c != TextSource::end;) {
        const std::size_t line = source.line();
        std::string text;
        while ((c = source.get()) != TextSource::end && c != '\n') text += char(c);
        LineReader reader(std::move(text), path, line);
        if (reader.empty()) continue;
        if (frames.size() == max_frames)
            throw InputError(printable_path(path), line, "a frame too many",
                             std::to_string(max_frames) + " at most");
        frames.push_back(reader.read());
    }
    if (frames.empty())
        throw InputError(printable_path(path), 0, "no frames",
                         std::string("a frame a line: ") + words_of_a_frame);
    return frames;
}

View view_of(const FrameLine& frame, View view, const std::filesystem::path& list) {
    if (frame.from) view.from = *frame.from;
    if (frame.at) view.at = *frame.at;
    if (frame.up) view.up = *frame.up;
    if (frame.angle) view.angle = *frame.angle;
    if (const std::optional<ViewFault> fault = fault_of(view))
        throw InputError(printable_path(list), frame.line, fault->what, fault->expected);
    return view;
}

}  // namespace raycell
