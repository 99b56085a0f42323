#include "testbench/golden/file.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace raycell {
namespace {

constexpr std::array<const char*, 7> whats{"in", "free", "phase", "drain", "out", "take", "pixel"};
constexpr std::array<const char*, 5> sides{"east", "south", "west", "north", "load"};
constexpr Cycle most_cycles = Cycle(1) << 48;

/// Throws GoldenError with the file's name and the line.
[[noreturn]] void fail(const std::string& name, int line, const std::string& what) {
    throw GoldenError(name + ":" + std::to_string(line) + ": " + what);
}

/// Throws GoldenError unless a record's first line is this version's.
void check_version(const std::string& name, const std::string& line) {
    if (line == golden_version) return;
    const std::string kind = "raycell-golden ";
    if (line.rfind(kind, 0) != 0) fail(name, 1, std::string("expected '") + golden_version + "'");
    fail(name, 1,
         "golden vectors of version '" + line.substr(kind.size(), 20) + "': expected '" + golden_version +
             "'; record them anew with 'raycell render --golden' or 'cell_tb SCENARIO --write'");
}

class EventReader {
  public:
    EventReader(const std::string& name, int line, const std::vector<std::string>& tokens,
                std::vector<std::string> remarks = {})
        : name_(name), line_(line), tokens_(tokens), remarks_(std::move(remarks)) {}

    GoldenEvent read() {
        GoldenEvent event;
        event.line = line_;
        event.remarks = remarks_;
        event.cycle = number("a cycle", most_cycles);
        event.what = GoldenEvent::What(word(whats, "what happens"));
        switch (event.what) {
            case GoldenEvent::What::in:
            case GoldenEvent::What::out:
                read_buffer(event);
                event.cycles = int(number("cycles on the link", 1000000000));
                if (event.cycles == 0) refuse("cycles on the link", "0", "at least 1");
                event.bits = next("bits");
                if (event.bits == no_bits) event.bits.clear();
                read_rest(event, 1, 1000);
                break;
            case GoldenEvent::What::free:
            case GoldenEvent::What::take:
                read_buffer(event);
                read_rest(event, 0, 0);
                break;
            case GoldenEvent::What::phase:
            case GoldenEvent::What::drain:
                read_rest(event, 1, 1);
                break;
            case GoldenEvent::What::pixel:
                read_rest(event, 3, 3);
                break;
        }
        return event;
    }

  private:
    [[noreturn]] void refuse(const std::string& what, const std::string& token, const std::string& expected) {
        fail(name_, line_, what + ": '" + token.substr(0, 60) + "': expected " + expected);
    }
    const std::string& next(const std::string& what) {
        if (at_ == tokens_.size()) fail(name_, line_, what + " is missing");
        return tokens_[at_++];
    }
    std::uint64_t number(const std::string& what, std::uint64_t most) {
        const std::string& token = next(what);
        std::uint64_t value = 0;
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, value);
        if (stop != end || error != std::errc() || value > most)
            refuse(what, token, "a number from 0 to " + std::to_string(most));
        return value;
    }
    template <std::size_t N>
    std::size_t word(const std::array<const char*, N>& words, const std::string& what) {
        const std::string& token = next(what);
        std::string all;
        for (std::size_t i = 0; i < N; ++i) {
            if (token == words[i]) return i;
            all += (i ? ", " : "") + std::string(words[i]);
        }
        refuse(what, token, "one of " + all);
    }
    void read_buffer(GoldenEvent& event) {
        event.side = int(word(sides, "side"));
        event.index = int(number("buffer class", 4));
        const bool towards = event.what == GoldenEvent::What::in || event.what == GoldenEvent::What::take;
        if (event.side == GoldenEvent::load_link && (!towards || event.index != 0))
            refuse("side", "load", "'in load 0' or 'take load 0'");
    }
    void read_rest(GoldenEvent& event, std::size_t least, std::size_t most) {
        event.tokens.assign(tokens_.begin() + std::ptrdiff_t(at_), tokens_.end());
        if (event.tokens.size() < least) fail(name_, line_, "words are missing at the end");
        if (event.tokens.size() > most)
            fail(name_, line_, "'" + event.tokens[most].substr(0, 60) + "': expected no more");
    }

    const std::string& name_;
    int line_;
    const std::vector<std::string>& tokens_;
    std::vector<std::string> remarks_;
    std::size_t at_ = 0;
};

/// Reads a file line by line.
class FileReader {
  public:
    explicit FileReader(const std::string& name) { file_.name = name; }

    void line(std::string text) {
        ++number_;
        if (!text.empty() && text.back() == '\r') text.pop_back();
        if (number_ == 1) return check_version(file_.name, text);
        if (text.rfind("config ", 0) == 0 && !begun_) {
            file_.configuration += text.substr(7) + "\n";
            return;
        }
        const auto mark = std::min(text.find(remark_mark), text.size());
        GoldenFile::Line line{number_, tokens_of(text.substr(0, mark))};
        if (mark < text.size()) line.remarks = tokens_of(text.substr(mark + 1));
        if (line.tokens.empty() || line.tokens[0][0] == '#') return;
        if (ended_) fail(file_.name, number_, "expected nothing behind 'end'");
        if (begun_) {
            behind_head(std::move(line));
        } else if (line.tokens[0] == "begin") {
            begun_ = true;
        } else if (text.substr(0, mark) == traversal_part) {
            file_.traversal = true;
        } else {
            file_.head.push_back(std::move(line));
        }
    }

    GoldenFile finish() {
        if (number_ == 0) check_version(file_.name, "");
        if (!ended_) fail(file_.name, number_, "expected 'CYCLE end': the record is not whole");
        if (before_ > file_.last) fail(file_.name, number_, "the record ends before its last event");
        return std::move(file_);
    }

  private:
    void behind_head(GoldenFile::Line line) {
        if (line.tokens.size() == 2 && line.tokens[1] == "end") {
            file_.last = EventReader(file_.name, number_, {line.tokens[0], "drain", "0"}).read().cycle;
            ended_ = true;
        } else if (file_.traversal) {
            file_.lines.push_back(std::move(line));
        } else {
            file_.events.push_back(EventReader(file_.name, number_, line.tokens, line.remarks).read());
            check_order(file_.events.back());
        }
    }
    void check_order(const GoldenEvent& event) {
        if (event.what == GoldenEvent::What::pixel) return;  // written after the run, so out of order
        if (event.cycle < before_)
            fail(file_.name, number_,
                 "cycle " + std::to_string(event.cycle) + " comes after cycle " + std::to_string(before_) +
                     "; expected them in order");
        before_ = event.cycle;
    }

    GoldenFile file_;
    int number_ = 0;
    bool begun_ = false;
    bool ended_ = false;
    Cycle before_ = 0;
};

}  // namespace

const char* name_of_side(int side) { return sides[std::size_t(side)]; }

std::string text_of(const GoldenEvent& event) {
    std::string text = std::to_string(event.cycle) + " " + whats[std::size_t(event.what)];
    using What = GoldenEvent::What;
    const bool buffer = event.what != What::phase && event.what != What::drain && event.what != What::pixel;
    if (buffer) text += std::string(" ") + name_of_side(event.side) + " " + std::to_string(event.index);
    if (event.what == What::in || event.what == What::out)
        text += " " + std::to_string(event.cycles) + " " + (event.bits.empty() ? no_bits : event.bits);
    for (const std::string& token : event.tokens) text += " " + token;
    if (!event.remarks.empty()) text += std::string(" ") + remark_mark;
    for (const std::string& remark : event.remarks) text += " " + remark;
    return text;
}

GoldenFile read_golden(std::istream& in, const std::string& name) {
    FileReader reader(name);
    for (std::string line; std::getline(in, line);) reader.line(line);
    return reader.finish();
}

}  // namespace raycell
