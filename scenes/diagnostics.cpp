#include "scenes/diagnostics.hpp"

namespace raycell {

namespace {

std::string place(const std::string& file, std::size_t line) {
    return line == 0 ? file + ": " : file + ":" + std::to_string(line) + ": ";
}

}  // namespace

InputError::InputError(const std::string& file, std::size_t line, const std::string& what,
                       const std::string& expected)
    : std::runtime_error(place(file, line) + what + "; expected " + expected) {}

std::string printable(std::string_view word, std::size_t limit) {
    static const char digits[] = "0123456789abcdef";
    std::string out;
    for (const char c : word) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = byte >= 0x20 && byte < 0x7f;
        if (out.size() + (plain ? 1 : 4) > limit) return out + "...";
        if (plain) {
            out += c;
        } else {
            out += "\\x";
            out += digits[byte >> 4];
            out += digits[byte & 15];
        }
    }
    return out;
}

void Diagnostics::warn(const std::string& file, std::size_t line, const std::string& kind,
                       const std::string& text, std::size_t shown) {
    ++warnings_;
    Kind& group = kinds_[{kind, file}];
    ++group.count;
    group.last_line = line;
    if (group.shown >= shown) return;
    ++group.shown;
    group.last_shown = messages_.size();
    messages_.push_back(place(file, line) + "warning: " + text);
}

void Diagnostics::note(const std::string& file, const std::string& text) {
    messages_.push_back(file + ": note: " + text);
}

std::vector<std::string> Diagnostics::messages() const {
    std::vector<std::string> out = messages_;
    for (const auto& [name, kind] : kinds_) {
        if (kind.count == kind.shown) continue;
        out[kind.last_shown] += " (and " + std::to_string(kind.count - kind.shown) +
                                " more of this kind, the last in line " + std::to_string(kind.last_line) +
                                ")";
    }
    return out;
}

std::size_t Diagnostics::count_of(const std::string& kind) const {
    std::size_t count = 0;
    for (auto at = kinds_.lower_bound({kind, ""}); at != kinds_.end() && at->first.first == kind; ++at)
        count += at->second.count;
    return count;
}

}  // namespace raycell
