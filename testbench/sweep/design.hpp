// A sweep as its user wrote it, and the runs that it is made of.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace raycell {

/// An option of the program that is run, and the values that it takes one after the other.
struct SweepAxis {
    std::string option;  ///< without its dashes; "scene" for the positional word
    std::vector<std::string> values;
};

/// One run: a value of each axis.
struct SweepPoint {
    std::vector<std::string> values;
};

/// Every combination of its axes' values is run once.
struct SweepDesign {
    std::vector<SweepAxis> axes;  ///< in the order in which they were given
    /// Of every run: options that may come several times in one ("--cost=walk_step=4").
    std::vector<std::string> fixed;
    std::map<std::string, std::string> digests;  ///< of the contents of scenes, views and presets

    /// Indices of the axes of several values, in their order.
    std::vector<std::size_t> varying() const;
    std::size_t size() const;
    std::vector<SweepPoint> points() const;
    /// A run's options as words of a command line.
    std::vector<std::string> words(const SweepPoint& point) const;
    /// A file name that tells the runs of a sweep apart. It changes with any option, with the contents of
    /// scenes, view files and presets, and with `program`, a text that tells programs apart.
    std::string name(const SweepPoint& point, const std::string& program) const;
};

/// Most runs of one sweep.
constexpr std::size_t most_sweep_runs = 100000;

/// A digest of a text: 16 hexadecimal digits.
std::string digest(const std::string& text);
/// A digest of a file's contents; of a file that can't be read, that of nothing.
std::string digest_of(const std::string& path);

/// Reads options with values, lists ("1,2,4") and ranges ("1..8", "8..64:8") of whole numbers; a word that
/// the option takes as it stands is one value, whatever is in it. An option that comes several times has all
/// the values. Words without a dash are scenes. `program` has the options. Throws UsageError for an unknown
/// option or a value that it refuses, saying what it takes.
SweepDesign read_sweep(const std::vector<std::string>& words, CLI::App& program);

/// The words that a configuration file of a sweep or of a run stands for: keys are options, values are
/// numbers, words, true or false, or lists. What can't be swept is left out. Throws UsageError naming file
/// and line.
std::vector<std::string> sweep_words_from_file(const std::string& path);

}  // namespace raycell
