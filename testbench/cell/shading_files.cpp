#include "testbench/cell/shading_files.hpp"

#include <algorithm>

#include "testbench/cell/hardware_text.hpp"

namespace raycell {
namespace {

using Word = MicroMachine::Value;

constexpr const char* step_names[] = {"CALL",   "END",    "END_OF_SETUP", "FIRST_LIGHT", "IF_LIGHT",
                                      "IF_LIT", "IF_ANY", "IF_POSITIVE",  "FACES",       "EMIT_LIGHT",
                                      "EMIT",   "NEXT",   "JUMP"};

/// Packs fields into a word, the first one at the top.
class WordPacker {
  public:
    void add(std::size_t value, int bits) {
        word_ = word_ << bits | Word(value);
        bits_ += bits;
    }
    std::string line() const { return MicroImage::hexadecimal(word_, bits_) + "\n"; }

  private:
    Word word_ = 0;
    int bits_ = 0;
};

/// What a destination is called in a copy.
std::size_t target_code(ShadeSpace space) {
    return space == ShadeSpace::own ? 0 : space == ShadeSpace::slot ? 1 : 2;
}

}  // namespace

const std::vector<std::string>& shading_ray_words() {
    static const std::vector<std::string> names = {"x",  "y",      "z",          "dx", "dy",
                                                   "dz", "weight", "generation", "t"};
    return names;
}

const std::vector<std::string>& shading_child_words() {
    static const std::vector<std::string> names = {"x",  "y",  "z",  "dx",     "dy",    "dz",   "mx",
                                                   "ex", "my", "ey", "weight", "reach", "front"};
    return names;
}

const std::vector<std::string>& shading_result_words() {
    static const std::vector<std::string> names = {"reflects", "refracts", "polygon", "object",
                                                   "red",      "green",    "blue"};
    return names;
}

std::vector<std::pair<std::string, std::string>> shading_files(const ShadingCalls& c,
                                                               const ShadingSizes& sizes) {
    const MicroImage& image = c.image();
    std::size_t most = image.register_count();
    for (std::size_t space = 1; space < shade_spaces; ++space)
        most = std::max(most, c.words(ShadeSpace(space)).size());
    const int number = bits_of(most);
    std::size_t copies = 0, longest = 0;
    for (const ShadeCall& call : c.calls()) copies += call.before.size() + call.after.size();
    const int copy = bits_of(copies + 1);
    const int entry = image.entry_bits();
    std::string copy_text, call_text, script_text;
    std::size_t at = 0;
    const auto add_copies = [&](const std::vector<ShadeCopy>& all) {
        for (const ShadeCopy& one : all) {
            WordPacker word;
            word.add(std::size_t(one.from.space), 3);
            word.add(c.number(one.from), number);
            word.add(target_code(one.to.space), 2);
            word.add(c.number(one.to), number);
            copy_text += word.line();
            ++at;
        }
    };
    for (const ShadeCall& call : c.calls()) {
        WordPacker word;
        word.add(at, copy);
        copy_text += "// " + call.name + "\n";
        add_copies(call.before);
        word.add(at, copy);
        add_copies(call.after);
        word.add(at, copy);
        word.add(image.entry(call.program), entry);
        call_text += "// " + call.name + "\n" + word.line();
    }
    std::size_t argument = c.calls().size();
    std::uint32_t charge = 0;
    for (const ShadeStep& step : c.script()) {
        argument = std::max(argument, step.argument + 1);
        charge = std::max(charge, step.charge);
    }
    const int argument_bits = bits_of(argument);
    const int step_bits = bits_of(c.script().size());
    const int charge_bits = bits_of(charge + 1);
    for (const ShadeStep& step : c.script()) {
        WordPacker word;
        word.add(std::size_t(step.op), 4);
        word.add(step.argument, argument_bits);
        word.add(step.target, step_bits);
        word.add(step.charge, charge_bits);
        script_text += word.line();
        longest += step.charge;
    }

    PackageText package("shade", "sizes, words, calls and script of the shading unit.");
    package.sizes(image);
    package.number("SLOTS", sizes.slots);
    package.number("SLOT_BITS", std::size_t(bits_of(sizes.slots)));
    package.number("SLOT_WORDS", c.words(ShadeSpace::slot).size());
    package.number("VOXELS_MOST", sizes.voxels);
    package.number("VOXEL_BITS", std::size_t(bits_of(sizes.voxels)));
    package.number("VOXEL_WORDS", c.words(ShadeSpace::voxel).size());
    package.number("OBJECTS_MOST", sizes.objects);
    package.number("OBJECT_BITS", std::size_t(bits_of(sizes.objects)));
    package.number("OBJECT_WORDS", c.words(ShadeSpace::object).size());
    package.number("SOURCES_MOST", sizes.sources);
    package.number("SOURCE_WORDS", c.words(ShadeSpace::source).size());
    package.number("LIGHT_BITS", std::size_t(bits_of(sizes.sources + 1)));
    package.number("CHILD_BITS", std::size_t(bits_of(sizes.sources + 2)));
    package.number("CELL_BITS", std::size_t(bits_of(sizes.cells)));
    const std::size_t largest = std::max({sizes.voxels * c.words(ShadeSpace::voxel).size(),
                                          sizes.objects * c.words(ShadeSpace::object).size(),
                                          sizes.sources * c.words(ShadeSpace::source).size()});
    package.number("MEMORY_BITS", std::size_t(bits_of(largest)));
    package.number("OUTS", c.words(ShadeSpace::out).size());
    package.number("NUMBER_BITS", std::size_t(number));
    package.number("COPIES", copies);
    package.number("COPY_BITS", std::size_t(copy));
    package.number("CALLS", c.calls().size());
    package.number("CALL_BITS", std::size_t(bits_of(c.calls().size())));
    package.number("STEPS", c.script().size());
    package.number("STEP_BITS", std::size_t(step_bits));
    package.number("ARGUMENT_BITS", std::size_t(argument_bits));
    package.number("STEP_CHARGE_BITS", std::size_t(charge_bits));
    package.number("CHARGE_BITS",
                   std::size_t(bits_of((longest + 1) * std::max<std::size_t>(sizes.sources, 1))));
    package.number("SHADE_ENTRY", c.shade_entry());
    for (std::size_t i = 0; i < std::size(step_names); ++i)
        package.number(std::string("STEP_") + step_names[i], i);
    // Where loading and the cell's control find words.
    for (std::size_t space = 0; space < shade_spaces; ++space) {
        constexpr const char* names[] = {"OWN", "VOXEL", "OBJECT", "SOURCE", "SLOT", "PORT", "OUT"};
        package.number(std::string("SPACE_") + names[space], space);
        const auto& words = c.words(ShadeSpace(space));
        for (std::size_t i = 0; i < words.size(); ++i)
            package.number(std::string(names[space]) + "_" + constant_name(words[i]), i);
    }
    for (const std::string& name : shading_ray_words())
        package.number("F_" + constant_name(name), c.number(c.place("setup." + name)));
    return {{"shade.sv", package.text()},
            {"shading_programs.hex", image.instruction_file()},
            {"shading_tables.hex", image.table_file()},
            {"shading_copies.hex", copy_text},
            {"shading_calls.hex", call_text},
            {"shading_script.hex", script_text},
            {"shading_registers.hex", image.register_file()}};
}

}  // namespace raycell
