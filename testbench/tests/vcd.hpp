// Reads a value change dump (VCD), independently of the code that wrote it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace raycell::vcd {

struct Change {
    std::uint64_t cycle;
    std::string value;  ///< numbers in binary, strings without their s
    bool operator==(const Change& other) const { return cycle == other.cycle && value == other.value; }
};
inline std::ostream& operator<<(std::ostream& out, const Change& change) {
    return out << change.cycle << ":" << change.value;
}

struct Dump {
    std::map<std::string, std::string> kinds;            ///< by path: wire, string
    std::map<std::string, std::vector<Change>> changes;  ///< by path; the first is the initial value
    std::vector<std::uint64_t> stamps;                   ///< cycles
    std::vector<std::string> comments;

    const std::vector<Change>& of(const std::string& path) const {
        static const std::vector<Change> none;
        const auto found = changes.find(path);
        EXPECT_NE(found, changes.end()) << "no signal " << path;
        return found == changes.end() ? none : found->second;
    }
    /// The value in a cycle; empty before the first change.
    std::string at(const std::string& path, std::uint64_t cycle) const {
        std::string value;
        for (const Change& change : of(path)) {
            if (change.cycle <= cycle) value = change.value;
        }
        return value;
    }
};

/// Parses a dump. `period_ps` is the clock period in ps; a time that is not a whole cycle fails the test.
inline Dump parse(const std::string& text, std::uint64_t period_ps) {
    Dump dump;
    std::istringstream in(text);
    std::map<std::string, std::string> paths;  // by code
    std::vector<std::string> scopes;
    std::uint64_t unit_ps = 0;
    const auto to_end = [&in] {
        std::vector<std::string> words;
        for (std::string word; in >> word && word != "$end";) words.push_back(word);
        return words;
    };
    const auto change = [&](const std::string& code, const std::string& value) {
        const auto path = paths.find(code);
        ASSERT_NE(path, paths.end()) << "a change of '" << code << "', which is not declared";
        ASSERT_FALSE(dump.stamps.empty()) << "a change without a time";
        dump.changes[path->second].push_back({dump.stamps.back(), value});
    };
    for (std::string word; in >> word;) {
        if (word == "$timescale") {
            const auto words = to_end();
            const std::string& unit = words.at(1);
            unit_ps = std::stoull(words.at(0)) * (unit == "ps"   ? 1
                                                  : unit == "ns" ? 1000
                                                  : unit == "us" ? 1000000
                                                                 : 1000000000);
        } else if (word == "$scope") {
            scopes.push_back(to_end().at(1));
        } else if (word == "$upscope") {
            to_end();
            scopes.pop_back();
        } else if (word == "$var") {
            const auto words = to_end();
            std::string path;
            for (const std::string& scope : scopes) path += scope + ".";
            path += words.at(3);
            EXPECT_TRUE(paths.emplace(words.at(2), path).second) << "code " << words.at(2) << " twice";
            EXPECT_TRUE(dump.kinds.emplace(path, words.at(0)).second) << path << " twice";
            dump.changes[path];
        } else if (word == "$comment") {
            std::string line;
            for (const std::string& part : to_end()) line += (line.empty() ? "" : " ") + part;
            dump.comments.push_back(line);
        } else if (word == "$dumpvars" || word == "$end") {
            continue;
        } else if (word[0] == '$') {
            to_end();
        } else if (word[0] == '#') {
            const std::uint64_t ps = std::stoull(word.substr(1)) * unit_ps;
            EXPECT_EQ(ps % period_ps, 0u) << "no whole cycle: " << word;
            if (!dump.stamps.empty()) {
                EXPECT_GT(ps / period_ps, dump.stamps.back());
            }
            dump.stamps.push_back(ps / period_ps);
        } else if (word[0] == 'b' || word[0] == 's') {
            std::string code;
            in >> code;
            change(code, word.substr(1));
        } else {
            change(word.substr(1), word.substr(0, 1));
        }
    }
    EXPECT_TRUE(scopes.empty());
    return dump;
}

}  // namespace raycell::vcd
