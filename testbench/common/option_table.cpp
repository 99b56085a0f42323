// How options of each kind are read, checked and written down.
#include "testbench/common/options.hpp"
#include "testbench/common/ray_watch.hpp"

namespace raycell {
namespace {

/// Leaves out what a run puts behind its prefix; returns no error.
std::string without_suffix(std::string& word) {
    for (const char* suffix : {".png", ".exr", ".json", ".toml", ".csv", ".vcd"}) {
        const std::string end = suffix;
        const auto at = word.size() - end.size();
        if (word.size() <= end.size() || word.substr(at) != end || word[at - 1] == '/') continue;
        word.resize(at);
        break;
    }
    return "";
}

}  // namespace

void OptionTable::text(const std::string& name, std::string& target, const std::string& type,
                       const std::string& help) {
    const bool output = name == "output";
    CLI::Option* option = app_.add_option(output ? "-o,--output" : "--" + name, target, help);
    option->group(group_)->type_name(type)->capture_default_str()->take_last();
    // Whoever names a picture means the prefix of all results.
    if (output) option->transform(CLI::Validator([](std::string& word) { return without_suffix(word); }, ""));
    entries_.push_back({name, [&target] { return nlohmann::ordered_json(target); }});
}

void OptionTable::table_size(const std::string& name, int& target, const std::string& help) {
    number(name, target, 0, 4096, help);
    const auto check = [](const std::string& word) -> std::string {
        int entries = 0;
        if (parse_number(word, entries) && (entries == 0 || (entries >= 4 && (entries & (entries - 1)) == 0)))
            return "";
        return "expected 0 or a power of two from 4 to 4096, not '" + printable(word) + "'";
    };
    app_.get_option("--" + name)->check(CLI::Validator(check, ""));
}

void OptionTable::positional(const std::string& name, std::string& target, const std::string& help) {
    app_.add_option_function<std::string>(
            name, [&target](const std::string& word) { target = word; }, help)
        ->type_name("FILE");
}

void OptionTable::flag(const std::string& name, bool& target, const std::string& help) {
    app_.add_flag("--" + name, target, help)->group(group_)->take_last();
    entries_.push_back({name, [&target] { return nlohmann::ordered_json(target); }});
}

void OptionTable::size(const std::string& name, int& width, int& height, const std::string& help,
                       const std::string& none) {
    const auto parse = [](const std::string& word, int& w, int& h) {
        const auto x = word.find('x');
        return x != std::string::npos && parse_number(word.substr(0, x), w) &&
               parse_number(word.substr(x + 1), h) && w >= 1 && h >= 1 && w <= 4096 && h <= 4096;
    };
    const auto check = [parse, none](const std::string& word) -> std::string {
        int w = 0;
        int h = 0;
        if (parse(word, w, h) || (!none.empty() && word == none)) return "";
        return "expected " + (none.empty() ? "" : none + " or ") + "WxH from 1x1 to 4096x4096, not '" +
               printable(word) + "'";
    };
    const auto set = [parse, &width, &height](const std::string& word) {
        if (!parse(word, width, height)) width = height = 0;
    };
    const auto text = [&width, &height, none] {
        return width == 0 ? none : std::to_string(width) + "x" + std::to_string(height);
    };
    app_.add_option_function<std::string>("--" + name, set, help)
        ->group(group_)
        ->check(CLI::Validator(check, "WxH"))
        ->default_str(text())
        ->take_last();
    entries_.push_back({name, [text] { return nlohmann::ordered_json(text()); }});
}

namespace {

/// "3" or "3..7".
bool parse_span(const std::string& word, int& from, int& to) {
    const auto dots = word.find("..");
    if (dots == std::string::npos) return parse_number(word, from) && parse_number(word, to) && from >= 0;
    return parse_number(word.substr(0, dots), from) && parse_number(word.substr(dots + 2), to) && from >= 0 &&
           from <= to;
}

bool parse_cells(const std::string& word, CellRange& range) {
    const auto comma = word.find(',');
    return comma != std::string::npos && parse_span(word.substr(0, comma), range.x0, range.x1) &&
           parse_span(word.substr(comma + 1), range.y0, range.y1);
}

/// "FROM:TO", either side may be empty.
bool parse_window(const std::string& word, CycleWindow& window) {
    const auto colon = word.find(':');
    if (colon == std::string::npos) return false;
    window = CycleWindow();
    const std::string from = word.substr(0, colon);
    const std::string to = word.substr(colon + 1);
    return (from.empty() || parse_number(from, window.from)) && (to.empty() || parse_number(to, window.to)) &&
           window.from <= window.to;
}

std::string text_of(const CellRange& range) {
    const auto span = [](int from, int to) {
        return from == to ? std::to_string(from) : std::to_string(from) + ".." + std::to_string(to);
    };
    return span(range.x0, range.x1) + "," + span(range.y0, range.y1);
}

}  // namespace

void OptionTable::cells(const std::string& name, std::vector<CellRange>& target, const std::string& help) {
    const auto check = [](const std::string& word) -> std::string {
        CellRange range;
        if (parse_cells(word, range)) return "";
        return "expected X,Y or X0..X1,Y0..Y1 from 0 on, not '" + printable(word) + "'";
    };
    const auto set = [&target](const std::vector<std::string>& words) {
        target.clear();
        for (const std::string& word : words) parse_cells(word, target.emplace_back());
    };
    app_.add_option_function<std::vector<std::string>>("--" + name, set, help)
        ->group(group_)
        ->check(CLI::Validator(check, "X0..X1,Y0..Y1"))
        ->allow_extra_args(false);
    entries_.push_back({name, [&target] {
                            nlohmann::ordered_json list = nlohmann::ordered_json::array();
                            for (const CellRange& range : target) list.push_back(text_of(range));
                            return list;
                        }});
}

void OptionTable::shares(const std::string& name, double& p, double& q, const std::string& help) {
    const auto share = [](const std::string& word, double& value) {
        return parse_number(word, value) && value >= 0 && value <= 1;
    };
    const auto parse = [share](const std::string& word, double& first, double& second) {
        const auto comma = word.find(',');
        second = 0;
        if (comma == std::string::npos) return share(word, first);
        return share(word.substr(0, comma), first) && share(word.substr(comma + 1), second);
    };
    const auto check = [parse](const std::string& word) -> std::string {
        double first = 0;
        double second = 0;
        if (parse(word, first, second)) return "";
        return "expected P or P,Q, each from 0 to 1, not '" + printable(word) + "'";
    };
    const auto text = [&p, &q] {
        const auto shortest = [](double value) {
            char digits[32];
            return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
        };
        return shortest(p) + (q != 0 ? "," + shortest(q) : "");
    };
    app_.add_option_function<std::string>(
            "--" + name, [parse, &p, &q](const std::string& word) { parse(word, p, q); }, help)
        ->group(group_)
        ->check(CLI::Validator(check, "P[,Q]"))
        ->default_str(text())
        ->take_last();
    entries_.push_back({name, [text] { return nlohmann::ordered_json(text()); }});
}

void OptionTable::rays(const std::string& name, std::vector<std::uint64_t>& target, const std::string& help) {
    const auto check = [](const std::string& word) -> std::string {
        std::uint64_t id = 0;
        if (parse_ray(word, id)) return "";
        return "expected PIXEL/BRANCH, or PIXEL.SAMPLE/BRANCH, as reports name a ray, not '" +
               printable(word) + "'";
    };
    const auto set = [&target](const std::vector<std::string>& words) {
        target.clear();
        for (const std::string& word : words) parse_ray(word, target.emplace_back());
    };
    app_.add_option_function<std::vector<std::string>>("--" + name, set, help)
        ->group(group_)
        ->check(CLI::Validator(check, "PIXEL/BRANCH"))
        ->allow_extra_args(false);
    entries_.push_back({name, [&target] {
                            nlohmann::ordered_json list = nlohmann::ordered_json::array();
                            for (const std::uint64_t id : target) list.push_back(ray_name(id));
                            return list;
                        }});
}

void OptionTable::window(const std::string& name, CycleWindow& target, const std::string& help) {
    const auto check = [](const std::string& word) -> std::string {
        CycleWindow window;
        if (parse_window(word, window)) return "";
        return "expected FROM:TO, cycles from 0 on, either may be left out, not '" + printable(word) + "'";
    };
    const auto set = [&target](const std::string& word) { parse_window(word, target); };
    app_.add_option_function<std::string>("--" + name, set, help)
        ->group(group_)
        ->check(CLI::Validator(check, "FROM:TO"))
        ->default_str(":")
        ->take_last();
    entries_.push_back({name, [&target] {
                            const std::string from = target.from == 0 ? "" : std::to_string(target.from);
                            const bool open = target.to == CycleWindow::open;
                            return nlohmann::ordered_json(from + ":" +
                                                          (open ? "" : std::to_string(target.to)));
                        }});
}

void OptionTable::costs(CostTable& table) {
    // Before --cost, which changes single entries of what is set here.
    const std::vector<std::pair<std::string, CostBasis>> bases = {{"word", CostBasis::word},
                                                                  {"wide", CostBasis::wide},
                                                                  {"two", CostBasis::two},
                                                                  {"estimate", CostBasis::estimate}};
    const auto choose = [&table, bases](const std::string& word) {
        for (const auto& [name, basis] : bases) {
            if (name == word) table = CostTable(basis);
        }
    };
    app_.add_option_function<std::string>("--datapath", choose,
                                          "whose counted cycles are taken: of one multiplier of words, one "
                                          "that takes a distance whole, two of "
                                          "words; or estimates by hand")
        ->group(group_)
        ->check(CLI::IsMember({"word", "wide", "two", "estimate"}))
        ->default_str("word")
        ->take_last();
    entries_.push_back({"datapath", [&table, bases] {
                            for (const auto& [name, basis] : bases) {
                                if (basis == table.basis) return nlohmann::ordered_json(name);
                            }
                            return nlohmann::ordered_json();
                        }});
    std::string names;
    for (const auto& [name, member] : CostTable::entries()) {
        names += (names.empty() ? "" : ", ") + name + "=" + std::to_string(table.*member);
    }
    const auto set = [&table](const std::vector<std::string>& words) {
        for (const std::string& word : words) table.set(word);
    };
    const auto check = [](const std::string& word) -> std::string {
        try {
            CostTable().set(word);
            return "";
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
    };
    app_.add_option_function<std::vector<std::string>>(
            "--cost", set, "cycles of an operation; may come several times. " + names)
        ->group(group_)
        ->check(CLI::Validator(check, "NAME=CYCLES"))
        ->allow_extra_args(false);  // one entry each time: the next word may be the scene
    entries_.push_back({"cost", [&table] {
                            nlohmann::ordered_json list = nlohmann::ordered_json::array();
                            for (const auto& [name, member] : CostTable::entries()) {
                                list.push_back(name + "=" + std::to_string(table.*member));
                            }
                            return list;
                        }});
}

nlohmann::ordered_json OptionTable::values() const {
    nlohmann::ordered_json all;
    for (const Entry& entry : entries_) all[entry.name] = entry.value();
    return all;
}

}  // namespace raycell
