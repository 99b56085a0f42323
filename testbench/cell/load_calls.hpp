// Loading from spans as calls of microprograms and a script of them: what loading.sv does.
#pragma once

#include <string>
#include <vector>

#include "model/tracing/tracing.hpp"
#include "testbench/cell/load_script.hpp"
#include "testbench/cell/unit_calls.hpp"

namespace raycell {

/// A part of a message, of `bits` bits from the `low`-th sent on; of a source, `stride` bits more for each
/// one before it.
struct LoadPart {
    std::size_t field;
    int low;
    int bits;
    bool with_sign;
    int stride = 0;
};

/// The unit of one machine.
class LoadCalls {
  public:
    /// Throws std::invalid_argument for settings that the unit does not know.
    explicit LoadCalls(const Context& context);

    const UnitCalls& unit() const { return unit_; }
    const LoadScript& script() const { return script_; }
    const std::vector<LoadPart>& parts() const { return parts_; }

    /// Words of a voxel and of an edge in the unit's own memories, and of a voxel in the traversal's store.
    std::size_t voxel_stride() const { return stored_.size(); }
    std::size_t edge_stride() const { return edge_.size(); }
    std::size_t line_stride() const { return store_.size(); }
    /// Words of a line of its index table.
    static constexpr std::size_t table_stride() { return 2; }

    // The words that the unit writes out, in their order: names of fields.
    const std::vector<std::string>& store_words() const { return store_; }
    const std::vector<std::string>& edge_words() const { return edge_; }
    const std::vector<std::string>& voxel_words() const { return shading_; }
    const std::vector<std::string>& object_words() const { return object_; }
    const std::vector<std::string>& source_words() const { return source_; }
    std::string constants() const;

  private:
    void name_fields(const Context& context);
    void find_parts(const Context& context);
    void add_calls(const Context& context);
    void write_messages();
    void write_span();
    void write_voxel();
    void write_join();
    void write_order();
    void write_advance();
    void write_finish();

    UnitCalls unit_{"load"};
    LoadScript script_{unit_};
    std::vector<LoadPart> parts_;
    std::vector<std::string> stored_, edge_, store_, shading_, object_, source_;
};

}  // namespace raycell
