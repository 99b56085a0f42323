// The ports of a cell, for modules in an array.
#pragma once

#include <systemc>

#include "cells/channels/link.hpp"

namespace raycell {

/// The ports of a cell. Ports at a border without a link may stay unbound. A module may be sensitive to its
/// ports.
class CellPorts : public sc_core::sc_module {
  public:
    template <typename Interface>
    using Port = sc_core::sc_port<Interface, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

    explicit CellPorts(sc_core::sc_module_name name)
        : sc_module(name), in("in", side_count), out("out", side_count), load_in("load_in") {}

    sc_core::sc_vector<Port<LinkIn>> in;    ///< by Side
    sc_core::sc_vector<Port<LinkOut>> out;  ///< by Side
    Port<LinkIn> load_in;                   ///< from the row's distributor (first column only)

    // The channels bound to the ports; null at a border without a link.
    LinkIn* input(Side side) { return bound(in[std::size_t(side)]); }
    LinkOut* output(Side side) { return bound(out[std::size_t(side)]); }
    /// The input of load messages: load_in in the first column, where the distributor is bound, else the west
    /// input.
    LinkIn* load_input() { return load_in.size() > 0 ? load_in[0] : input(Side::west); }

  private:
    template <typename Interface>
    static Interface* bound(Port<Interface>& port) {
        return port.size() > 0 ? port[0] : nullptr;
    }
};

}  // namespace raycell
