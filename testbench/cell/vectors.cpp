#include "testbench/cell/vectors.hpp"

#include "testbench/common/configuration.hpp"
#include "testbench/common/options.hpp"
#include "testbench/golden/memory_file.hpp"
#include "testbench/golden/messages.hpp"

namespace raycell {
namespace {

constexpr const char* text_suffix = ".txt";

/// Packs the messages of a scenario, whose events have only their words.
std::vector<GoldenEvent> packed_events(const Scenario& scenario, const Words& words, const Packing& packing) {
    std::vector<GoldenEvent> events = scenario.events;
    MessagePools pools;
    for (GoldenEvent& event : events) {
        if (event.what != GoldenEvent::What::in && event.what != GoldenEvent::What::out) continue;
        const Message message = read_message(words, event.tokens, event.remarks, {}, pools);
        if (const auto bits = packing.bits_of(message)) {
            event.bits = bits->hex();
            event.bit_count = bits->size();
        }
        give_back(message, pools);
    }
    return events;
}

/// Writes the vectors of a scenario: its setup and its events. `name` is its place behind the prefix,
/// `text_name` that of the file with the words.
void write_one(const Scenario& scenario, const std::string& name, const std::string& text_name,
               OutputSet& outputs) {
    RenderOptions options;
    CLI::App app{"configuration"};
    OptionTable table(app);
    add_scene_options(table, options);
    add_machine_options(table, options);
    options.picture = scenario.setup.picture;
    options.machine = scenario.setup.machine;
    const Context context(scenario.setup.scene, scenario.setup.picture);
    const Words words(context.arithmetic, options.picture);
    const Packing packing(context, options.machine);
    std::string text = setup_text(scenario.setup, context, to_toml(table.values()));
    const std::vector<GoldenEvent> events = packed_events(scenario, words, packing);
    for (const GoldenEvent& event : events) text += text_of(event) + "\n";
    outputs.write(text_name, text + std::to_string(scenario.last) + " end\n");
    const MemoryFiles memory =
        memory_files(MemoryText(words.formats(), packing.widest()), events, scenario.last);
    const bool packed = packing.widest() > 0;
    outputs.write_if(packed, name + memory_in_suffix, [&] { return memory.in; });
    outputs.write_if(packed, name + memory_out_suffix, [&] { return memory.out; });
}

/// The names of a scenario's files behind the prefix: their stem, and the one with the words.
struct Names {
    std::string stem;
    std::string text;
};
Names names_of(const Scenario& scenario, const std::string& write) {
    if (is_folder(write)) return {scenario.name, scenario.name + text_suffix};
    return {"", write.substr(vector_prefix(write).size())};
}

}  // namespace

std::string vector_prefix(const std::string& write) {
    const std::string suffix = text_suffix;
    const bool named = write.size() > suffix.size() && write.substr(write.size() - suffix.size()) == suffix;
    return named ? write.substr(0, write.size() - suffix.size()) : write;
}

std::vector<std::string> vector_suffixes(const std::vector<Scenario>& scenarios, const std::string& write) {
    std::vector<std::string> all;
    for (const Scenario& scenario : scenarios) {
        const Names names = names_of(scenario, write);
        all.insert(all.end(), {names.text, names.stem + memory_in_suffix, names.stem + memory_out_suffix});
    }
    return all;
}

void write_vectors(const std::vector<Scenario>& scenarios, const std::string& write, OutputSet& outputs) {
    for (const Scenario& scenario : scenarios) {
        const Names names = names_of(scenario, write);
        write_one(scenario, names.stem, names.text, outputs);
    }
}

}  // namespace raycell
