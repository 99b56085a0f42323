#include "testbench/sweep/design.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "model/files/input_file.hpp"
#include "model/numbers/hash.hpp"
#include "testbench/common/nearest_option.hpp"
#include "testbench/common/options.hpp"
#include "testbench/common/presets.hpp"

namespace raycell {
namespace {

/// Whether the program takes `--option=word`; else why not.
std::string refusal(CLI::App& program, const std::string& option, const std::string& word) {
    try {
        program.parse(std::vector<std::string>{"--" + option + "=" + word});
        return "";
    } catch (const CLI::ParseError& error) {
        return error.what();
    }
}

/// "a..b" or "a..b:step", whole numbers; empty if it is none.
std::vector<std::string> range_of(const std::string& word) {
    const auto dots = word.find("..");
    if (dots == std::string::npos) return {};
    const auto colon = word.find(':', dots);
    std::int64_t from = 0;
    std::int64_t to = 0;
    std::int64_t step = 1;
    const std::string last = word.substr(dots + 2, colon == std::string::npos ? colon : colon - dots - 2);
    if (!parse_number(word.substr(0, dots), from) || !parse_number(last, to)) return {};
    if (colon != std::string::npos && !parse_number(word.substr(colon + 1), step)) return {};
    if (step < 1 || to < from || std::uint64_t(to - from) / std::uint64_t(step) >= most_sweep_runs) return {};
    std::vector<std::string> values;
    for (std::int64_t value = from; value <= to; value += step) values.push_back(std::to_string(value));
    return values;
}

std::vector<std::string> split(const std::string& word) {
    std::vector<std::string> parts;
    std::istringstream stream(word);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

/// What no sweep can say of its runs.
bool is_a_runs_own(const std::string& name) {
    const char* const own[] = {"output", "config", "quiet", "help", "save-array", "load-array"};
    return std::find(std::begin(own), std::end(own), name) != std::end(own);
}

class Reader {
  public:
    explicit Reader(CLI::App& program) : program_(program) {}

    SweepDesign read(const std::vector<std::string>& words) {
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i].rfind("--", 0) != 0) {
                if (words[i].rfind("-", 0) == 0)
                    throw UsageError("sweep: unknown option " + printable(words[i]));
                if (!program_.get_option_no_throw("--scene"))
                    throw UsageError("sweep: " + printable(words[i]) +
                                     ": expected no scene with --synthetic, or --synthetic left out");
                add("scene", words[i]);
                continue;
            }
            const auto equals = words[i].find('=');
            const std::string name = words[i].substr(2, equals == std::string::npos ? equals : equals - 2);
            const CLI::Option* option = known(name);
            if (option->get_items_expected_max() == 0) {
                add_values(name, {equals == std::string::npos ? "true" : words[i].substr(equals + 1)});
            } else if (equals != std::string::npos) {
                add_list(name, words[i].substr(equals + 1));
            } else if (i + 1 < words.size()) {
                add_list(name, words[++i]);
            } else {
                throw UsageError("--" + name + ": expected a value");
            }
        }
        std::size_t runs = 1;
        for (const SweepAxis& axis : design_.axes) {
            runs *= axis.values.size();
            if (runs > most_sweep_runs)
                throw UsageError("sweep: more than " + std::to_string(most_sweep_runs) +
                                 " runs; expected fewer values");
        }
        for (const SweepAxis& axis : design_.axes) {
            const bool preset = axis.option == "preset";
            if (axis.option != "scene" && axis.option != "view" && axis.option != "sources" &&
                axis.option != "frames" && !preset)
                continue;
            for (const std::string& name : axis.values)
                design_.digests[name] = digest_of(preset ? preset_file(name) : name);
        }
        return std::move(design_);
    }

  private:
    const CLI::Option* known(const std::string& name) const {
        const bool refused = is_a_runs_own(name);
        const CLI::Option* option = refused ? nullptr : program_.get_option_no_throw("--" + name);
        if (option) return option;
        const std::string meant = nearest_option(program_, "--" + name);
        throw UsageError("sweep: --" + printable(name) + (refused ? ": can't be swept" : ": unknown option") +
                         "; expected an option of " + program_.get_name() +
                         (meant.empty() || refused ? ", see its --help" : ", perhaps " + meant));
    }

    void add_list(const std::string& name, const std::string& word) {
        const std::string whole = refusal(program_, name, word);
        if (whole.empty()) return add_values(name, {word});
        std::vector<std::string> values;
        for (const std::string& part : split(word)) {
            const std::vector<std::string> range = range_of(part);
            if (range.empty()) {
                values.push_back(part);
            } else {
                values.insert(values.end(), range.begin(), range.end());
            }
        }
        for (const std::string& value : values) {
            const std::string why = refusal(program_, name, value);
            if (!why.empty()) throw UsageError("sweep: " + why);
        }
        if (values.empty()) throw UsageError("sweep: " + whole);
        add_values(name, values);
    }

    void add_values(const std::string& name, const std::vector<std::string>& values) {
        for (const std::string& value : values) add(name, value);
    }

    void add(const std::string& name, const std::string& value) {
        const CLI::Option* option = program_.get_option_no_throw("--" + name);
        if (option && option->get_items_expected_max() > 1) {
            design_.fixed.push_back("--" + name + "=" + value);
            return;
        }
        auto& axes = design_.axes;
        auto axis =
            std::find_if(axes.begin(), axes.end(), [&](const SweepAxis& a) { return a.option == name; });
        if (axis == axes.end()) axis = axes.insert(axes.end(), SweepAxis{name, {}});
        std::vector<std::string>& values = axis->values;
        if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }

    CLI::App& program_;
    SweepDesign design_;
};

}  // namespace

std::string digest(const std::string& text) {
    Fnv hash;
    for (const char c : text) hash.add(std::uint64_t(static_cast<unsigned char>(c)));
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash.value()));
    return digits;
}

std::string digest_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return digest(text.str());
}

std::vector<std::string> SweepDesign::words(const SweepPoint& point) const {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < axes.size(); ++i)
        all.push_back("--" + axes[i].option + "=" + point.values[i]);
    all.insert(all.end(), fixed.begin(), fixed.end());
    return all;
}

std::string SweepDesign::name(const SweepPoint& point, const std::string& program) const {
    std::string text;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].values.size() < 2) continue;
        const bool scene = axes[i].option == "scene";
        text += (text.empty() ? "" : "_") + (scene ? "" : axes[i].option + "=") +
                (scene ? std::filesystem::path(point.values[i]).stem().string() : point.values[i]);
    }
    for (char& c : text) {
        if (c == '/' || c == '\\' || c == ' ') c = '-';
    }
    constexpr std::size_t longest = 150;  // names of files have 255
    if (text.size() > longest) text.resize(longest);
    std::string everything = program;
    for (const std::string& word : words(point)) everything += '\n' + word;
    for (const std::string& value : point.values) {
        const auto file = digests.find(value);
        if (file != digests.end()) everything += '\n' + file->second;
    }
    return text + (text.empty() ? "" : "_") + digest(everything).substr(0, 8);
}

std::vector<std::size_t> SweepDesign::varying() const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].values.size() > 1) found.push_back(i);
    }
    return found;
}

std::size_t SweepDesign::size() const {
    std::size_t runs = 1;
    for (const SweepAxis& axis : axes) runs *= axis.values.size();
    return runs;
}

std::vector<SweepPoint> SweepDesign::points() const {
    std::vector<SweepPoint> all = {{}};
    for (const SweepAxis& axis : axes) {
        std::vector<SweepPoint> longer;
        for (const SweepPoint& point : all) {
            for (const std::string& value : axis.values) {
                longer.push_back(point);
                longer.back().values.push_back(value);
            }
        }
        all = std::move(longer);
    }
    return all;
}

SweepDesign read_sweep(const std::vector<std::string>& words, CLI::App& program) {
    return Reader(program).read(words);
}

std::vector<std::string> sweep_words_from_file(const std::string& path) {
    const std::string fault = input_fault(path);
    if (!fault.empty()) throw UsageError(path + ": " + fault + "; expected a configuration file");
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    const auto fail = [&](const toml::source_region& where, const std::string& what) -> UsageError {
        return UsageError(path + ":" + std::to_string(where.begin.line) + ": " + what);
    };
    std::vector<std::string> words;
    const auto add = [&](const std::string& key, const toml::node& node) {
        // An empty word is the default of a file's name.
        if (is_a_runs_own(key) || node.value_exact<std::string>() == std::string()) return;
        std::string value;
        if (const auto word = node.value_exact<std::string>()) {
            value = *word;
        } else if (const auto whole = node.value_exact<std::int64_t>()) {
            value = std::to_string(*whole);
        } else if (const auto real = node.value_exact<double>()) {
            char digits[64];  // the shortest that reads back as the same number
            value.assign(digits, std::to_chars(digits, digits + sizeof digits, *real).ptr);
        } else if (const auto truth = node.value_exact<bool>()) {
            value = *truth ? "true" : "false";
        } else {
            throw fail(node.source(),
                       "key '" + printable(key) + "': expected a number, a word or a list of them");
        }
        words.push_back("--" + key + "=" + value);
    };
    try {
        const toml::table table = toml::parse(text.str());
        std::map<std::size_t, std::string> keys;  // by line: a sweep's axes are in the order of its file
        for (const auto& [name, node] : table) keys[node.source().begin.line] = std::string(name.str());
        for (const auto& [line, key] : keys) {
            const toml::node& node = *table.get(key);
            if (const toml::array* list = node.as_array()) {
                for (const toml::node& item : *list) add(key, item);
            } else {
                add(key, node);
            }
        }
    } catch (const toml::parse_error& error) {
        throw fail(error.source(), printable(error.description(), 120) + "; expected TOML");
    }
    return words;
}

}  // namespace raycell
