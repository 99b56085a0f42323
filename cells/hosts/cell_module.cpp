#include "cells/hosts/cell_module.hpp"

namespace raycell {
namespace {

/// The link that a port is bound to, null if there is none.
template <typename Port>
Link* link_of(Port& port) {
    if (port.size() == 0) return nullptr;
    Link* link = dynamic_cast<Link*>(port[0]);
    if (!link) {
        SC_REPORT_ERROR("raycell",
                        (std::string(port.name()) + " is bound to a channel that is no Link").c_str());
    }
    return link;
}

}  // namespace

CellModule::CellModule(sc_core::sc_module_name name, Environment& environment, Cell& cell)
    : sc_module(name),
      in("in", side_count),
      out("out", side_count),
      load_in("load_in"),
      environment_(environment),
      cell_(cell) {
    cell_.set_host(*this);
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

CellModule::CellModule(sc_core::sc_module_name name, Environment& environment, int x, int y)
    : CellModule(name, environment, *new Cell(environment, x, y)) {
    own_.reset(&cell_);
}

void CellModule::end_of_elaboration() {
    for (int side = 0; side < side_count; ++side) {
        const auto i = std::size_t(side);
        if (Link* link = link_of(in[i])) cell_.connect_in(Side(side), *link);
        if (Link* link = link_of(out[i])) cell_.connect_out(Side(side), *link);
    }
    if (Link* link = link_of(load_in)) cell_.connect_load(*link);
    cell_.elaborate();
}

void CellModule::run() {
    const Cycle next = cell_.step(environment_.scheduler.now());
    if (next != never) environment_.scheduler.wake(cell_, next);
}

}  // namespace raycell
