#include "testbench/common/options.hpp"

#include "scenes/frame_list.hpp"
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

void OptionTable::size(const std::string& name, int& width, int& height, const std::string& help) {
    const auto parse = [](const std::string& word, int& w, int& h) {
        const auto x = word.find('x');
        return x != std::string::npos && parse_number(word.substr(0, x), w) &&
               parse_number(word.substr(x + 1), h) && w >= 1 && h >= 1 && w <= 4096 && h <= 4096;
    };
    const auto check = [parse](const std::string& word) -> std::string {
        int w = 0;
        int h = 0;
        return parse(word, w, h) ? "" : "expected WxH from 1x1 to 4096x4096, not '" + printable(word) + "'";
    };
    const auto set = [parse, &width, &height](const std::string& word) { parse(word, width, height); };
    app_.add_option_function<std::string>("--" + name, set, help)
        ->group(group_)
        ->check(CLI::Validator(check, "WxH"))
        ->default_str(std::to_string(width) + "x" + std::to_string(height))
        ->take_last();
    entries_.push_back({name, [&width, &height] {
                            return nlohmann::ordered_json(std::to_string(width) + "x" +
                                                          std::to_string(height));
                        }});
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
        return "expected PIXEL/BRANCH, two numbers from 0 to 4294967295, not '" + printable(word) + "'";
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

void add_placement_options(OptionTable& table, RenderOptions& options) {
    table.group("Scene");
    PictureSettings& p = options.picture;
    table.text("scene", options.scene, "FILE", "scene: .nff or .obj");
    table.positional("file", options.scene, "the same; has precedence over --scene");
    table.text("view", options.view, "FILE.nff", "take background, view and sources from this file");
    table.text("sources", options.sources, "FILE.toml",
               "light sources that replace those of the scene, or are added to them");
    table.text("frames", options.frames, "FILE",
               "frames in a row: a list of views and scenes, one a line; all of them, or that of --frame");
    table.number("frame", options.frame, 0, int(max_frames),
                 "this one of --frames alone, from 1; 0: all, which only render can");
    table.choice("viewer", p.viewer, {{"scene", ViewerMode::scene}, {"infinity", ViewerMode::infinity}},
                 "viewer at the scene's distance, or at infinity (axial primary rays)");
    table.size("cells", p.width, p.height, "size of the array, one cell per pixel");
    table.number("chord-error", p.chord_error, 1e-3, 1e3,
                 "depth of a curved object's facets below their corners, cells; half of it lies outside");
    table.number(
        "tessellate-for", p.tessellate_for, 0.0, 100.0,
        "PSNR of the polygons against the scene, dB, that chooses a chord error for each curved object; "
        "0: --chord-error for all");
}

void add_scene_options(OptionTable& table, RenderOptions& options) {
    PictureSettings& p = options.picture;
    add_placement_options(table, options);
    table.group("Results");
    table.text("output", options.prefix, "PREFIX",
               "where results go: PREFIX.exr, PREFIX.png, PREFIX.json, ...");
    table.group("Rays");
    table.number("max-depth", p.max_depth, 0, 62, "generations of rays after the primary one");
    table.number("min-weight", p.min_weight, 0.0, 1.0, "share of a pixel below which a ray is not sent");
    table.group("Results");
    table.flag("quiet", options.quiet, "no progress, no summary");
}

void add_truth_samples(OptionTable& table, RenderOptions& options) {
    table.group("Truth");
    table.number("truth-samples", options.truth_samples, 1, 65536,
                 "the truth's own samples of each source that is an area");
}

void add_link_options(OptionTable& table, MachineSettings& m) {
    table.group("Links and clock");
    table.number("link-bits", m.link_bits, 1, 4096, "bits that cross a link per cycle");
    table.number("loading-units", m.loading_units, 1, most_units,
                 "units of a cell that make voxels while the array is loaded, each one at a time");
    table.number("traversal-units", m.traversal_units, 1, most_units,
                 "units of a cell that test rays, each one at a time");
    table.number("start-within", m.start_within, 0U, 1U << 24U,
                 "primary rays start spread over so many cycles of the trace; 0: all at once");
    table.number("load-queue", m.load_queue, 0, 65535,
                 "spans that a cell keeps until their voxels are made; 0: no limit");
    table.number("feed-bits", m.feed_bits, 1, 4096,
                 "bits that cross a link of the feed per cycle: from geometry to the rows' distributors");
    table.number("feed-lanes", m.feed_lanes, 1, 4096,
                 "geometry and precomputation units, each for some of the rows");
    table.number("clock-mhz", m.clock_mhz, 1e-3, 1e5, "clock, MHz");
    table.number(
        "stall", m.stall, 0.0, 0.9,
        "probability that a transfer or an operation takes a cycle more, and again; drawn by --seed");
    table.number("max-cycles", m.max_cycles, std::int64_t(0), std::int64_t(1) << 62,
                 "timed engine: stop after so many cycles; 0: never");
}

void add_communication_options(OptionTable& table, MachineSettings& m) {
    table.group("Ray store, buffers and networks");
    table.number("ray-store", m.ray_store, 1, 1024, "M, rays that a cell can store, slots");
    table.number("buffer", m.buffer_depth, 1, 1024, "depth of every buffer, messages");
    table.choice("networks", m.networks,
                 {{"half", Networks::half},
                  {"quadrant", Networks::quadrant},
                  {"split", Networks::split},
                  {"shared", Networks::shared}},
                 "which messages share a buffer");
    table.choice("recovery", m.recovery, {{"postpone", Recovery::postpone}, {"none", Recovery::none}},
                 "a ray that finds no slot: destroyed and sent again, or left waiting");
    table.choice("slots", m.slots,
                 {{"reserved", Slots::reserved}, {"free", Slots::free}, {"nested", Slots::nested}},
                 "slots kept by generation, free for all, or kept for deeper generations alone");
    add_link_options(table, m);
}

void add_granularity_options(OptionTable& table, RenderOptions& options) {
    table.group("Simulation");
    table.choice(
        "granularity", options.hosts,
        {{"auto", Hosts::automatic}, {"cell", Hosts::cell}, {"tile", Hosts::tile}},
        "what runs the cells: a SystemC module each, or one for a block of them, which is faster and "
        "smaller; auto: tiles, but modules for the cells that --detail, --probe or --golden name. No "
        "result depends on it");
    table.cells("detail", options.detail,
                "these cells are modules, with ports, all others in tiles; may come several times");
}

void add_voxel_options(OptionTable& table, PictureSettings& p) {
    table.group("Voxels and hit test");
    table.number("depth", p.depth_levels, 1, 65536, "depth levels of the cube");
    table.choice("hit", p.hit,
                 {{"edge", HitTest::edge},
                  {"mask", HitTest::mask},
                  {"plane", HitTest::plane},
                  {"interval", HitTest::interval},
                  {"depth", HitTest::depth}},
                 "what a cell compares a ray with");
    table.choice("normals", p.normals, {{"linear", Normals::linear}, {"voxel", Normals::voxel}},
                 "normals interpolated at the hit, or one per voxel");
    table.choice("shadows", p.shadows,
                 {{"per-hit", Shadows::per_hit}, {"precast", Shadows::precast}, {"memo", Shadows::memo}},
                 "a ray per hit and source, or sample of it; a bit per voxel and such a ray before tracing; "
                 "the same when "
                 "first hit");
    table.number("voxel-capacity", p.voxel_capacity, 0, 1000000, "voxels that a cell can hold; 0: unlimited");
    table.choice("display", p.display, {{"phong", Display::phong}, {"gouraud", Display::gouraud}},
                 "shading of --stage load");
}

void add_word_options(OptionTable& table, NumberSettings& n) {
    table.group("Numbers");
    table.choice("arithmetic", n.arithmetic, {{"fixed", Numbers::fixed}, {"exact", Numbers::exact}},
                 "numbers of the cell: words of word-bits, or double precision");
    table.number("word-bits", n.word_bits, 8, 32, "bits of a word in messages, voxels and the ALU");
    table.choice("rounding", n.rounding, {{"nearest", Rounding::nearest}, {"truncate", Rounding::truncate}},
                 "words: to the nearest, ties to even, or cut off");
}

void add_machine_options(OptionTable& table, RenderOptions& options) {
    PictureSettings& p = options.picture;
    MachineSettings& m = options.machine;
    add_voxel_options(table, p);
    table.group("Simulation");
    table.choice("stage", p.stage, {{"trace", RunStage::trace}, {"load", RunStage::load}},
                 "trace rays, or stop after loading and show the nearest voxels");
    table.choice("engine", options.engine, {{"timed", Engine::timed}, {"untimed", Engine::untimed}},
                 "SystemC cells, or the recursive reference without time");
    add_granularity_options(table, options);
    table.group("Rays beyond the cube");
    table.choice("exterior", p.exterior, {{"host", ExteriorMode::host}, {"none", ExteriorMode::none}},
                 "rays that leave the cube: traced on by the exterior processors, or lost");
    add_word_options(table, p.numbers);
    table.group("Numbers");
    const std::vector<std::pair<std::string, Iteration>> iterations = {
        {"newton", Iteration::newton}, {"table", Iteration::table}, {"rounded", Iteration::rounded}};
    OperatorSettings& o = p.numbers.operators;
    table.choice("reciprocal", o.reciprocal, iterations,
                 "1/x: a table and one Newton step, the table alone, or digit by digit; cycles in --cost");
    table.choice("root", o.root, iterations, "1/sqrt(x), in the same ways");
    table.choice("power", o.power,
                 {{"tables", PowerMethod::tables},
                  {"schlick", PowerMethod::schlick},
                  {"rounded", PowerMethod::rounded}},
                 "Phong's power: by log2 and exp2 tables, Schlick's fraction, or digit by digit");
    table.table_size("reciprocal-table", o.reciprocal_table,
                     "its entries, a power of two from 4; 0: what the word length needs, 64 at 20 bits");
    table.table_size("root-table", o.root_table, "the same; 0: 64 at 20 bits");
    table.table_size("power-table", o.power_table, "the same, of each of its two tables; 0: 32 at 20 bits");
    add_communication_options(table, m);
    table.group("Rays");
    table.number("source-samples", p.source_samples, 1, int(max_sources),
                 "shadow rays from a hit, or a voxel, to each source that is an area");
    table.number("normal-offset", p.normal_offset, -1.0, 1.0,
                 "start of secondary rays off their polygon, cells; negative: what suits the arithmetic");
    table.group("Rays beyond the cube");
    table.number("exterior-processors", m.exterior_processors, 1, 1000000, "processors outside the cube");
    table.number("exterior-latency", m.exterior_latency, 1, 1000000000,
                 "cycles that one of them takes for a ray");
    table.group("Links and clock");
    table.number("seed", m.seed, std::uint64_t(0), ~std::uint64_t(0) >> 1, "of the back-off's jitter");
    table.flag(
        "wire-check", m.wire_check,
        "pack every ray and answer into its bits at every link and go on with what unpacks: the same picture "
        "in the same cycles");
    table.group("Costs");
    table.costs(m.costs);
    table.group("Truth");
    table.flag("truth", options.truth, "render the truth too and report the accuracy");
    table.flag("clip-truth", options.clip_truth, "clip the truth to the cube");
    add_truth_samples(table, options);
}

void add_array_options(OptionTable& table, RenderOptions& options) {
    table.group("Loaded arrays");
    table.text("save-array", options.save_array, "FILE",
               "keep the loaded array, for other traces of this scene and size");
    table.text("load-array", options.load_array, "FILE",
               "start with an array that --save-array kept, instead of loading it again");
}

void add_render_options(OptionTable& table, RenderOptions& options) {
    add_scene_options(table, options);
    add_machine_options(table, options);
    add_watch_options(table, options);
    add_recording_options(table, options);
    add_array_options(table, options);
    add_probe_options(table, options);
}

}  // namespace raycell
