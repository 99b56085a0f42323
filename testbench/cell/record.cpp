#include "testbench/cell/record.hpp"

#include <algorithm>
#include <fstream>

#include "model/files/input_file.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/options.hpp"

namespace raycell {
namespace {

/// The options of a recorded run, from the configuration in its head.
RenderOptions recorded_options(const GoldenFile& file) {
    RenderOptions options;
    CLI::App app{"configuration"};
    app.name("raycell render");
    OptionTable table(app);
    add_scene_options(table, options);
    add_machine_options(table, options);
    CLI::App other{"other"};
    RenderOptions ignored;
    OptionTable other_table(other);
    add_watch_options(other_table, ignored);
    add_recording_options(other_table, ignored);
    add_array_options(other_table, ignored);
    add_probe_options(other_table, ignored);
    std::vector<std::string> words =
        arguments_from_text(file.configuration, file.name + ": config", app, &other);
    std::reverse(words.begin(), words.end());
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        throw UsageError(file.name + ": config: " + error.what());
    }
    return options;
}

}  // namespace

Record record_of_file(const std::string& path) {
    const std::string fault = input_fault(path);
    if (!fault.empty())
        throw UsageError(path + ": " + fault +
                         "; expected golden vectors, as 'raycell render --golden' writes them");
    std::ifstream in(path);
    Record record{read_golden(in, path), {}};
    const RenderOptions options = recorded_options(record.file);
    record.setup.picture = options.picture;
    record.setup.machine = options.machine;
    if (options.picture.own_samples() != 1)
        throw UsageError(path + ": a cell has " + std::to_string(options.picture.own_samples()) +
                         " primary rays; expected a record of cells with one each");
    read_setup(record.file, record.setup);
    return record;
}

}  // namespace raycell
