// The SystemVerilog package of one machine: message layouts, widths, codes and constants, taken from the
// model's own layouts and tables, so that an RTL cell can't differ from the model in them.
#pragma once

#include <string>
#include <vector>

#include "model/machine/wire_bits.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// A machine that an RTL cell can be built for. `context` must outlive it.
class RtlPackage {
  public:
    /// Throws std::invalid_argument, naming the setting and what is allowed, for what the RTL cell has not.
    RtlPackage(const Context& context, const MachineSettings& machine);

    /// The text of raycell_pkg.sv.
    std::string verilog() const;
    /// The text of a C++ header with what a bench around the verilated cell has to know.
    std::string header() const;
    /// Bits of a link's message port: those of the widest message.
    int message_bits() const { return message_bits_; }

    /// One layout as the members of a packed struct. Bits are counted, so that tests can compare them.
    struct Struct {
        std::string name;
        std::vector<WireField> members;  ///< names are SystemVerilog identifiers
        int bits = 0;
    };
    /// Of ray, shadow_ray, intensity, verdict, the viewer's message without its sources, and the first fields
    /// of a span.
    std::vector<Struct> structs() const;

  private:
    std::string numbers() const;
    std::string machine_constants() const;
    std::string costs() const;
    std::string tables() const;
    std::string types() const;

    const Context& context_;
    const MachineSettings& machine_;
    int message_bits_;
};

}  // namespace raycell
