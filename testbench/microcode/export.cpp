#include "testbench/microcode/export.hpp"

#include <algorithm>
#include <sstream>

#include "testbench/common/new_file.hpp"
#include "testbench/microcode/image.hpp"

namespace raycell {
namespace {

std::vector<std::unique_ptr<MicroTrial>> chosen_trials(const MicroSetting& setting,
                                                       const std::string& names) {
    std::vector<std::unique_ptr<MicroTrial>> all = micro_trials(setting);
    if (names.empty()) return all;
    std::vector<std::unique_ptr<MicroTrial>> chosen;
    std::istringstream list(names);
    for (std::string name; std::getline(list, name, ',');) {
        std::string known;
        bool found = false;
        for (auto& trial : all) {
            if (!trial) continue;
            known += (known.empty() ? "" : ", ") + trial->program().name;
            if (trial->program().name != name) continue;
            chosen.push_back(std::move(trial));
            found = true;
            break;
        }
        if (!found)
            throw std::invalid_argument("--programs: there is no '" + name + "'; expected some of " + known);
    }
    return chosen;
}

std::string register_lines(const MicroImage& image, std::size_t program) {
    std::ostringstream text;
    const auto& registers = image.programs()[program]->registers;
    const std::vector<std::int64_t> values = image.initial_values(program);
    for (RegisterIndex i = 0; i < registers.size(); ++i)
        text << name_in_file(registers[i].name) << ' ' << registers[i].bits << ' ' << registers[i].fraction
             << ' ' << values[i] << '\n';
    return text.str();
}

/// The cycles, the registers before, the registers after: a word a line.
void write_vectors(NewFile& file, const MicroImage& image, MicroTrial& trial, const MicroExport& wanted) {
    MicroRandom random(wanted.seed);
    const auto words = [&](const std::vector<MicroMachine::Value>& values) {
        std::string text;
        for (const MicroMachine::Value value : values)
            text += MicroImage::hexadecimal(value, image.register_bits()) + "\n";
        return text;
    };
    for (std::uint64_t run = 0; run < wanted.runs; ++run) {
        const int cycles = trial.step(random);
        file.write(MicroImage::hexadecimal(cycles, 32) + "\n" + words(trial.inputs()) +
                   words(trial.results()));
    }
    if (trial.accumulator_bits() > image.accumulator_bits())
        throw std::logic_error("microprogram " + trial.program().name + ": its accumulator takes " +
                               std::to_string(trial.accumulator_bits()) + " bits, more than the bound of " +
                               std::to_string(image.accumulator_bits()));
}

}  // namespace

std::string export_programs(const MicroSetting& setting, const MicroExport& wanted) {
    const std::vector<std::unique_ptr<MicroTrial>> trials = chosen_trials(setting, wanted.programs);
    std::vector<const MicroProgram*> programs;
    for (const auto& trial : trials) programs.push_back(&trial->program());
    const MicroImage image(programs, false);
    std::vector<std::string> suffixes = {"microcode.sv", "programs.hex", "tables.hex", "programs.txt"};
    for (const MicroProgram* p : programs) {
        for (const char* end : {".registers.txt", ".registers.hex", ".vectors.hex"})
            suffixes.push_back(name_in_file(p->name) + end);
    }
    OutputSet files(wanted.folder + "/");
    files.announce(suffixes);
    files.write("microcode.sv", image.package());
    files.write("programs.hex", image.instruction_file());
    files.write("tables.hex", image.table_file());
    std::string index;
    for (std::size_t p = 0; p < programs.size(); ++p) {
        const std::string name = name_in_file(programs[p]->name);
        index += name + " " + std::to_string(image.entry(p)) + " " +
                 std::to_string(programs[p]->registers.size()) + " " + std::to_string(wanted.runs) + "\n";
        files.write(name + ".registers.txt", register_lines(image, p));
        std::string values;
        for (const std::int64_t value : image.initial_values(p))
            values += MicroImage::hexadecimal(value, image.register_bits()) + "\n";
        files.write(name + ".registers.hex", values);
        files.write(name + ".vectors.hex",
                    [&](NewFile& file) { write_vectors(file, image, *trials[p], wanted); });
    }
    files.write("programs.txt", index);
    files.publish();
    std::ostringstream text;
    text << wanted.folder << ": " << programs.size() << " programs, " << image.instruction_count()
         << " instructions of " << image.instruction_bits() << " bits, " << image.table_lines()
         << " lines of tables, " << image.register_count() << " registers of " << image.register_bits()
         << " bits, accumulator " << image.accumulator_bits() << " bits, words of " << image.word_bits()
         << " bits; " << wanted.runs << " vectors of each, seed " << wanted.seed << "\n";
    return text.str();
}

}  // namespace raycell
