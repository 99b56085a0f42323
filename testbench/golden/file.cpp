#include "testbench/golden/file.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace raycell {
namespace {

constexpr const char* first_line = "raycell-golden 1";
constexpr std::array<const char*, 7> whats{"in", "free", "phase", "drain", "out", "take", "pixel"};
constexpr std::array<const char*, 5> sides{"east", "south", "west", "north", "load"};
constexpr Cycle most_cycles = Cycle(1) << 48;

/// Throws GoldenError with the file's name and the line.
[[noreturn]] void fail(const std::string& name, int line, const std::string& what) {
    throw GoldenError(name + ":" + std::to_string(line) + ": " + what);
}

class EventReader {
  public:
    EventReader(const std::string& name, int line, const std::vector<std::string>& tokens)
        : name_(name), line_(line), tokens_(tokens) {}

    GoldenEvent read() {
        GoldenEvent event;
        event.line = line_;
        event.cycle = number("a cycle", most_cycles);
        event.what = GoldenEvent::What(word(whats, "what happens"));
        switch (event.what) {
            case GoldenEvent::What::in:
            case GoldenEvent::What::out:
                read_buffer(event);
                event.cycles = int(number("cycles on the link", 1000000000));
                if (event.cycles == 0) refuse("cycles on the link", "0", "at least 1");
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
    std::size_t at_ = 0;
};

}  // namespace

const char* name_of_side(int side) { return sides[std::size_t(side)]; }

std::string text_of(const GoldenEvent& event) {
    std::string text = std::to_string(event.cycle) + " " + whats[std::size_t(event.what)];
    using What = GoldenEvent::What;
    const bool buffer = event.what != What::phase && event.what != What::drain && event.what != What::pixel;
    if (buffer) text += std::string(" ") + name_of_side(event.side) + " " + std::to_string(event.index);
    if (event.what == What::in || event.what == What::out) text += " " + std::to_string(event.cycles);
    for (const std::string& token : event.tokens) text += " " + token;
    return text;
}

GoldenFile read_golden(std::istream& in, const std::string& name) {
    GoldenFile file;
    file.name = name;
    std::string line;
    int number = 0;
    bool begun = false;
    bool ended = false;
    Cycle before = 0;
    while (std::getline(in, line)) {
        ++number;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (number == 1) {
            if (line != first_line) fail(name, number, std::string("expected '") + first_line + "'");
            continue;
        }
        if (line.rfind("config ", 0) == 0 && !begun) {
            file.configuration += line.substr(7) + "\n";
            continue;
        }
        const std::vector<std::string> tokens = tokens_of(line);
        if (tokens.empty() || tokens[0][0] == '#') continue;
        if (ended) fail(name, number, "expected nothing behind 'end'");
        if (!begun) {
            begun = tokens[0] == "begin";
            if (!begun) file.head.push_back({number, tokens});
        } else if (tokens.size() == 2 && tokens[1] == "end") {
            const GoldenEvent end = EventReader(name, number, {tokens[0], "drain", "0"}).read();
            file.last = end.cycle;
            ended = true;
        } else {
            file.events.push_back(EventReader(name, number, tokens).read());
            const GoldenEvent& event = file.events.back();
            if (event.what == GoldenEvent::What::pixel) continue;  // written after the run, so out of order
            if (event.cycle < before)
                fail(name, number,
                     "cycle " + tokens[0] + " comes after cycle " + std::to_string(before) +
                         "; expected them in order");
            before = event.cycle;
        }
    }
    if (number == 0) fail(name, 1, std::string("expected '") + first_line + "'");
    if (!ended) fail(name, number, "expected 'CYCLE end': the record is not whole");
    if (before > file.last) fail(name, number, "the record ends before its last event");
    return file;
}

}  // namespace raycell
