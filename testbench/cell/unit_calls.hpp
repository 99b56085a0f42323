// A unit that computes by microprograms: its fields, and calls that copy them to registers, run a program and
// copy registers back.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "testbench/cell/hardware_text.hpp"
#include "testbench/microcode/image.hpp"

namespace raycell {

/// A program of a unit with its copies.
struct UnitCall {
    std::string name;
    std::size_t program;
    std::vector<std::pair<std::size_t, RegisterIndex>> loads;   ///< field, register
    std::vector<std::pair<RegisterIndex, std::size_t>> stores;  ///< register, field
    bool charged;  ///< the cost table has an entry for the program
};

class UnitCalls {
  public:
    /// `name`: of the unit's package and, with a `_`, of its files.
    explicit UnitCalls(std::string name) : name_(std::move(name)) {}
    UnitCalls(const UnitCalls&) = delete;
    UnitCalls& operator=(const UnitCalls&) = delete;

    using Names = std::vector<std::pair<std::string, std::string>>;
    /// `loads`: field to register; `stores`: register to field. Fields that do not exist are added. Throws
    /// std::logic_error if a field would hold words of two kinds.
    void add(const std::string& name, MicroProgram program, const Names& loads, const Names& stores,
             bool charged);
    /// The number of a field, which is added if it does not exist.
    std::size_t add_field(const std::string& name);
    /// Throw std::logic_error for a name that there is not.
    std::size_t field(const std::string& name) const;
    std::size_t call(const std::string& name) const;
    /// A number as the word that a field holds.
    std::int64_t word(const std::string& field, double value) const;

    const std::string& name() const { return name_; }
    const std::vector<std::string>& fields() const { return fields_; }
    const std::vector<UnitCall>& calls() const { return calls_; }
    const std::vector<std::unique_ptr<MicroProgram>>& programs() const { return programs_; }

  private:
    void same_fraction(const std::string& value, const MicroProgram& program, RegisterIndex index);

    std::string name_;
    std::vector<std::string> fields_;
    std::vector<UnitCall> calls_;
    std::vector<std::unique_ptr<MicroProgram>> programs_;
    std::map<std::string, int> fractions_;  ///< of each field's last bit
};

/// All programs of some units in one memory, with registers of their own.
MicroImage image_of(const std::vector<const UnitCalls*>& units);

/// What hardware reads of a unit's calls: files for $readmemh and constants of a package. `first_program`:
/// where the unit's programs begin among those of the image.
struct UnitFiles {
    std::string copies, calls, constants;
};
UnitFiles unit_files(const UnitCalls& unit, const MicroImage& image, std::size_t first_program);

std::string constant_line(const std::string& name, std::int64_t value);

}  // namespace raycell
