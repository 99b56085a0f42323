#include "testbench/common/presets.hpp"

#include <algorithm>
#include <filesystem>

#include "testbench/common/configuration.hpp"
#include "testbench/common/options.hpp"

namespace raycell {
namespace {

namespace fs = std::filesystem;

/// An installed program has its own presets; one in a build folder uses those of the source tree.
fs::path preset_folder() {
    std::error_code ignored;
    const fs::path installed =
        fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "share/raycell/presets";
    return fs::is_directory(installed, ignored) ? installed : fs::path(RAYCELL_PRESETS);
}

std::string allowed() {
    std::string words;
    for (const std::string& name : preset_names()) words += (words.empty() ? "" : "|") + name;
    return words;
}

std::string refusal(const std::string& name) {
    const std::vector<std::string> names = preset_names();
    if (names.empty()) return "no presets are installed; expected a folder " + preset_folder().string();
    if (std::find(names.begin(), names.end(), name) != names.end()) return "";
    return "expected one of " + allowed() + ", not '" + printable(name) + "'; --config takes any file";
}

}  // namespace

std::vector<std::string> preset_names() {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(preset_folder(), ignored)) {
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string preset_file(const std::string& name) {
    const std::string fault = refusal(name);
    if (!fault.empty()) throw UsageError("--preset: " + fault);
    return (preset_folder() / (name + ".toml")).string();
}

void add_preset_option(CLI::App& app) {
    app.add_option_function<std::string>(
           "--preset", [](const std::string&) {},
           "a machine with its options; --config and the command line have precedence")
        ->check(CLI::Validator(refusal, allowed()))
        ->take_last();
}

std::vector<std::string> preset_arguments(const std::vector<std::string>& words, const CLI::App& app) {
    if (!app.get_option_no_throw("--preset")) return {};
    const std::optional<std::string> name = last_word_of(words, "preset", "a name");
    return name ? arguments_from_render_file(preset_file(*name), app) : std::vector<std::string>();
}

}  // namespace raycell
