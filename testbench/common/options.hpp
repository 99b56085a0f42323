// The options of the programs: one table that makes --help, the configuration file and the JSON's config
// block.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "model/settings/settings.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// A wrong word on the command line or in a configuration file.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads a whole word as a decimal number; no octal, no blanks, nothing behind it, no overflow.
template <typename T>
bool parse_number(const std::string& word, T& value) {
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && stop == word.data() + word.size() && !word.empty();
}

/// Cycles of a run from its start, both ends included; `open`: to its end.
struct CycleWindow {
    static constexpr std::uint64_t open = ~std::uint64_t(0);
    std::uint64_t from = 0;
    std::uint64_t to = open;
};

/// What waveforms show of a run.
struct ProbeOptions {
    std::vector<CellRange> cells;
    CycleWindow window;
    bool on_deadlock = false;      ///< only the knot's cells, if the run deadlocks
    std::int64_t last = 2000;      ///< cycles before the deadlock formed
    std::int64_t mark = -1;        ///< cycle at which the view opens, with a marker; -1: the window's first
    std::int64_t limit_mb = 1024;  ///< largest dump, 10^6 bytes
};

/// Registers options with CLI11 and remembers how to read their effective values back.
class OptionTable {
  public:
    explicit OptionTable(CLI::App& app) : app_(app) {}

    /// The heading in --help of the options that are added from now on.
    void group(const std::string& name) { group_ = name; }

    /// A whole or real number from least to most.
    template <typename T>
    void number(const std::string& name, T& target, T least, T most, const std::string& help);
    /// Entries of an operator's table: a power of two from 4 to 4096, or 0.
    void table_size(const std::string& name, int& target, const std::string& help);
    void text(const std::string& name, std::string& target, const std::string& type, const std::string& help);
    /// A word without a dash in front; not part of the configuration.
    void positional(const std::string& name, std::string& target, const std::string& help);
    void flag(const std::string& name, bool& target, const std::string& help);
    template <typename E>
    void choice(const std::string& name, E& target, std::vector<std::pair<std::string, E>> values,
                const std::string& help);
    /// --cells WxH
    void size(const std::string& name, int& width, int& height, const std::string& help,
              const std::string& none = "");
    /// --NAME X,Y or X0..X1,Y0..Y1, may come several times: cells of the array. The command must check that
    /// they lie inside it.
    void cells(const std::string& name, std::vector<CellRange>& target, const std::string& help);
    /// --NAME P or P,Q: two shares from 0 to 1; P alone leaves Q at 0.
    void shares(const std::string& name, double& p, double& q, const std::string& help);
    /// --NAME PIXEL/BRANCH, may come several times: rays by their ids.
    void rays(const std::string& name, std::vector<std::uint64_t>& target, const std::string& help);
    /// --NAME FROM:TO, cycles; either side may be empty.
    void window(const std::string& name, CycleWindow& target, const std::string& help);
    /// --cost NAME=CYCLES, may come several times
    void costs(CostTable& table);

    /// Every option with its effective value.
    nlohmann::ordered_json values() const;

  private:
    struct Entry {
        std::string name;
        std::function<nlohmann::ordered_json()> value;
    };
    CLI::App& app_;
    std::string group_ = "Options";
    std::vector<Entry> entries_;
};

/// What runs the cells.
enum class Hosts {
    automatic,  ///< modules for cells of --detail, --probe and --golden, tiles for the others
    cell,       ///< a module for each cell
    tile        ///< tiles, but modules for the cells of --detail
};

/// What --golden records: all that a cell is told and does, or the tests of its traversal unit alone.
enum class GoldenPart { cell, traversal };

struct RenderOptions {
    std::string scene;
    std::string prefix = "out";
    std::string view;
    std::string sources;  ///< file of light sources; empty: the scene's own
    std::string frames;   ///< file of a list of frames; empty: none
    int frame = 0;        ///< of the list, from 1; 0: all
    PictureSettings picture;
    MachineSettings machine;
    Engine engine = Engine::timed;
    Hosts hosts = Hosts::automatic;
    std::vector<CellRange> detail;  ///< cells that are to be modules
    bool quiet = false;
    bool truth = false;
    bool clip_truth = false;
    int truth_samples = 256;  ///< of the truth, of each source that is an area
    std::vector<std::uint64_t> watch_rays;
    std::vector<CellRange> watch_pixels;
    ProbeOptions probes;
    int film = 0;                   ///< frames of the film; 0: none
    bool rays = false;              ///< a table of all rays
    std::string save_array;         ///< file for the loaded array; empty: none
    std::string config;             ///< file of options; empty: none
    std::string load_array;         ///< file of a loaded array to start with; empty: none
    std::vector<CellRange> golden;  ///< cells whose messages are written
    GoldenPart golden_part = GoldenPart::cell;
    std::vector<int> rank_rows;  ///< first rows of the bands after the first; empty: even bands
};

/// The scene, the view, the size of the array.
void add_placement_options(OptionTable& table, RenderOptions& options);
/// The options that render and truth share: placement, files, ray tree.
void add_scene_options(OptionTable& table, RenderOptions& options);
/// The truth's own samples of sources.
void add_truth_samples(OptionTable& table, RenderOptions& options);
void add_source_samples(OptionTable& table, PictureSettings& p);
/// Throws UsageError if --sample-until can't have an effect.
void check_samples(const PictureSettings& p);
/// What a cell makes of a span: depth levels, hit test, normals, shadow bits, capacity, intensities.
void add_voxel_options(OptionTable& table, PictureSettings& picture);
/// Arithmetic, its words and their rounding.
void add_word_options(OptionTable& table, NumberSettings& numbers);
/// Bits of a link, clock, stalls, limit of cycles.
void add_link_options(OptionTable& table, MachineSettings& machine);
/// Ray store, buffers, networks, recovery, and the link options.
void add_communication_options(OptionTable& table, MachineSettings& machine);
/// What runs the cells.
void add_granularity_options(OptionTable& table, RenderOptions& options);
/// What a run records for its page.
void add_recording_options(OptionTable& table, RenderOptions& options);
/// Options of render alone, for watching rays.
void add_watch_options(OptionTable& table, RenderOptions& options);
/// The other options of render.
void add_machine_options(OptionTable& table, RenderOptions& options);
/// All of render's but --config and what several ranks need.
void add_render_options(OptionTable& table, RenderOptions& options);
/// Loaded arrays as files.
void add_array_options(OptionTable& table, RenderOptions& options);
/// Waveforms of cells.
void add_waveform_options(OptionTable& table, RenderOptions& options);
/// Waveforms and golden vectors of cells.
void add_probe_options(OptionTable& table, RenderOptions& options);

template <typename T>
void OptionTable::number(const std::string& name, T& target, T least, T most, const std::string& help) {
    const auto in_range = [least, most](const std::string& word) -> std::string {
        T value{};
        // Written so that NaN fails too.
        if (!parse_number(word, value) || !(value >= least && value <= most)) {
            std::ostringstream text;
            text << "expected a number from " << least << " to " << most << ", not '" << printable(word)
                 << "'";
            return text.str();
        }
        return "";
    };
    std::ostringstream range;
    range << least << ".." << most;
    std::ostringstream now;
    now << target;
    app_.add_option_function<std::string>(
            "--" + name, [&target](const std::string& word) { parse_number(word, target); }, help)
        ->group(group_)
        ->check(CLI::Validator(in_range, range.str()))
        ->default_str(now.str())
        ->take_last();
    entries_.push_back({name, [&target] { return nlohmann::ordered_json(target); }});
}

template <typename E>
void OptionTable::choice(const std::string& name, E& target, std::vector<std::pair<std::string, E>> values,
                         const std::string& help) {
    const auto name_of_value = [values](E value) {
        for (const auto& [word, v] : values) {
            if (v == value) return word;
        }
        return std::string();
    };
    std::string words;
    for (const auto& entry : values) words += (words.empty() ? "" : "|") + entry.first;
    const auto set = [&target, values](const std::string& word) {
        for (const auto& [known, value] : values) {
            if (known == word) target = value;
        }
    };
    const auto known = [values, words](const std::string& word) -> std::string {
        for (const auto& entry : values) {
            if (entry.first == word) return "";
        }
        return "expected one of " + words + ", not '" + printable(word) + "'";
    };
    app_.add_option_function<std::string>("--" + name, set, help)
        ->group(group_)
        ->check(CLI::Validator(known, words))
        ->default_str(name_of_value(target))
        ->take_last();
    entries_.push_back(
        {name, [&target, name_of_value] { return nlohmann::ordered_json(name_of_value(target)); }});
}

}  // namespace raycell
