#include "scenes/obj_lines.hpp"

#include <algorithm>
#include <utility>

namespace raycell {

namespace {

constexpr std::string_view blanks = " \t\v\f\x1a";  // DOS ends a text with Ctrl-Z

void trim(std::string& line) {
    const std::size_t last = line.find_last_not_of(blanks);
    line.erase(last == std::string::npos ? 0 : last + 1);
    line.erase(0, line.find_first_not_of(blanks));
}

}  // namespace

LineReader::LineReader(TextSource source) : source_(std::move(source)) {}

bool LineReader::next(std::string& line) {
    line.clear();
    start_ = source_.line();
    int c = source_.get();
    if (c == TextSource::end) return false;
    bool comment = false;
    for (; c != TextSource::end; c = source_.get()) {
        if (c == '\n') {
            if (comment || line.empty() || line.back() != '\\') break;
            line.back() = ' ';
            continue;
        }
        // Inside a word '#' is part of a name: some modellers number their materials, "Material#25".
        comment =
            comment || (c == '#' && (line.empty() || blanks.find(line.back()) != std::string_view::npos));
        if (comment) continue;
        if (line.size() == max_length) {
            throw InputError(file(), start_, "a line of more than 4194304 characters", "shorter lines");
        }
        line += static_cast<char>(c);
    }
    if (!comment && !line.empty() && line.back() == '\\') line.pop_back();
    trim(line);
    return true;
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t at = line.find_first_not_of(blanks);
    while (at != std::string_view::npos) {
        const std::size_t stop = std::min(line.find_first_of(blanks, at), line.size());
        words.push_back(line.substr(at, stop - at));
        at = line.find_first_not_of(blanks, stop);
    }
    return words;
}

std::string UnknownWords::kind(std::string_view word) {
    const std::string name = printable(word);
    if (named_.count(name) == 0 && named_.size() == most_named) return "more unknown words";
    named_.insert(name);
    return "unknown word '" + name + "'";
}

std::string_view rest_of(std::string_view line) {
    const std::size_t word = std::min(line.find_first_of(blanks), line.size());
    const std::size_t at = line.find_first_not_of(blanks, word);
    return at == std::string_view::npos ? std::string_view() : line.substr(at);
}

LineFeed::int_type LineFeed::underflow() {
    do {
        if (!next_line(text_)) return traits_type::eof();
    } while (text_.empty());
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return traits_type::to_int_type(text_[0]);
}

}  // namespace raycell
