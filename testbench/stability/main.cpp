// stability_tb: shows where the machine's methods break, and what happens there: a table per study.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "testbench/common/version.hpp"
#include "testbench/stability/studies.hpp"

namespace {

using namespace raycell::stability;

struct UsageError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

struct Study {
    const char* name;
    const char* purpose;
    Report (*run)(const Effort&);
};

constexpr Study studies[] = {
    {"slopes", "rays through planes of slope 0 to 1000: what leaks, by rung and arithmetic", study_slopes},
    {"dda_drift", "drift of a ray over 1024 cells: the re-based walk beside a plain DDA", study_dda_drift},
    {"span_drift", "a span's increments over 1024 cells, with guard bits and without", study_span_drift},
    {"normals", "length and angle of interpolated, normalised normals", study_normals},
    {"grazing", "reflection at grazing angles: rays under the surface, rays that hit it again",
     study_grazing},
    {"critical", "refraction around the critical angle", study_critical},
    {"mirrors", "two facing mirrors, generation by generation", study_mirrors},
    {"offset", "shadow acne and light leaks against the normal offset", study_offset},
    {"near_viewer", "the viewer close to the screen: oblique primary rays", study_near_viewer},
    {"coincident", "coincident and crossing surfaces: which one is seen", study_coincident},
    {"small", "triangles smaller than a cell: where they get lost", study_small},
    {"chord_error", "spheres of ever finer facets: hits off the sphere, rays that get lost",
     study_chord_error},
    {"loading_order", "polygons loaded in another order: which pixels change", study_loading_order},
    {"saturation", "the ends of the formats: sources, colours, depths, shine, refraction", study_saturation},
};

const char* const help =
    "Usage: stability_tb [options]\n"
    "Runs studies of the machine's numbers and prints for each a table (Markdown), the boundary found and "
    "how\n"
    "the program treats it.\n"
    "  --study NAME  only this study; may be repeated\n"
    "  --csv FOLDER  also writes FOLDER/NAME.csv for each; the folder must exist\n"
    "  --quick       a tenth of the samples\n"
    "  --seed N      of all random draws (default 1)\n"
    "  --list        the studies' names and purposes\n"
    "  --version     what the program was built from\n"
    "  --help        this text\n";

struct Options {
    std::vector<Study> chosen;
    std::string csv;
    Effort effort;
    bool done = false;  ///< --help or --list was all
};

const Study& study_named(const std::string& name) {
    for (const Study& study : studies) {
        if (name == study.name) return study;
    }
    throw UsageError("--study " + name + ": unknown; --list names them");
}

std::uint64_t seed_in(const std::string& text) {
    std::uint64_t seed = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc{} || stop != text.data() + text.size()) {
        throw UsageError("--seed " + text + ": expected a whole number from 0");
    }
    return seed;
}

Options read(const std::vector<std::string>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& name = arguments[i];
        const auto value = [&]() -> const std::string& {
            if (i + 1 == arguments.size()) throw UsageError(name + ": expected a value");
            return arguments[++i];
        };
        if (name == "--help") {
            std::fputs(help, stdout);
            options.done = true;
            return options;
        } else if (name == "--version") {
            std::printf("stability_tb %s\n", raycell::version_text().c_str());
            options.done = true;
            return options;
        } else if (name == "--list") {
            for (const Study& study : studies) std::printf("%-12s %s\n", study.name, study.purpose);
            options.done = true;
            return options;
        } else if (name == "--quick") {
            options.effort.quick = true;
        } else if (name == "--study") {
            options.chosen.push_back(study_named(value()));
        } else if (name == "--csv") {
            options.csv = value();
            if (!std::filesystem::is_directory(options.csv)) {
                throw UsageError("--csv " + options.csv + ": expected an existing folder");
            }
        } else if (name == "--seed") {
            options.effort.seed = seed_in(value());
        } else {
            throw UsageError(name + ": unknown argument; --help lists them");
        }
    }
    if (options.chosen.empty()) options.chosen.assign(std::begin(studies), std::end(studies));
    return options;
}

void run(const Options& options) {
    std::printf("Seed %llu%s\n", static_cast<unsigned long long>(options.effort.seed),
                options.effort.quick ? ", quick" : "");
    for (const Study& study : options.chosen) {
        const Report report = study.run(options.effort);
        std::printf("\n## %s\n\n%s.\n\n", study.name, study.purpose);
        report.table.print_markdown();
        std::printf("\nBoundary: %s\nTreatment: %s\n", report.boundary.c_str(), report.treatment.c_str());
        std::fflush(stdout);
        if (!options.csv.empty()) {
            report.table.write_csv(std::filesystem::path(options.csv) / (std::string(study.name) + ".csv"));
        }
    }
}

}  // namespace

int main(int count, char** words) {
    try {
        const Options options = read({words + 1, words + count});
        if (!options.done) run(options);
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
            throw std::runtime_error("standard output can't be written");
        }
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "stability_tb: %s\n", error.what());
        return 1;
    }
}
