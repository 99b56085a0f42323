// A visit of a ray in a cell as calls of microprograms: what is copied to and from their registers.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/tracing/tracing.hpp"
#include "testbench/microcode/image.hpp"

namespace raycell {

/// Where a value is: among the unit's fields, or behind a place in its store, of a voxel or of an edge.
enum class ValueSpace { field, voxel, edge };

/// A value copied from a space, into a program's register or into a field.
struct Transfer {
    ValueSpace space;
    std::size_t from;
    bool to_field;
    std::size_t to;
};
/// Copies, then a program, then copies of its registers into fields.
struct VisitCall {
    std::string name;
    std::size_t program;
    std::vector<Transfer> loads;
    std::vector<std::pair<RegisterIndex, std::size_t>> stores;  ///< register, field
    bool charged;  ///< the cost table has an entry for the program
};

/// The programs, fields and calls of the traversal unit of one machine.
class VisitCalls {
  public:
    /// Throws std::invalid_argument for a rung other than `interval` and `edge`.
    explicit VisitCalls(const Context& context);
    VisitCalls(const VisitCalls&) = delete;
    VisitCalls& operator=(const VisitCalls&) = delete;

    const std::vector<std::string>& fields() const { return fields_; }
    const std::vector<std::string>& voxel_fields() const { return voxel_; }
    const std::vector<std::string>& edge_fields() const { return edge_; }
    const std::vector<VisitCall>& calls() const { return calls_; }
    const std::vector<std::unique_ptr<MicroProgram>>& programs() const { return programs_; }
    std::size_t field(const std::string& name) const;
    std::size_t call(const std::string& name) const;
    /// A number as the word that a field holds.
    std::int64_t word(ValueSpace space, const std::string& name, double value) const;

  private:
    using Names = std::vector<std::pair<std::string, std::string>>;
    /// `loads` are "name of the value" ("voxel near", "edge a") to "name of the register"; a register that is
    /// empty: to the field of the value's last word or words.
    void add(const std::string& name, MicroProgram program, const Names& loads, const Names& stores,
             bool charged);
    std::size_t found(std::vector<std::string>& names, const std::string& name);
    void same_fraction(const std::string& value, const MicroProgram& program, RegisterIndex index);

    std::vector<std::string> fields_, voxel_, edge_;
    std::vector<VisitCall> calls_;
    std::vector<std::unique_ptr<MicroProgram>> programs_;
    std::map<std::string, int> fractions_;  ///< of each value's last bit
};

}  // namespace raycell
