#include "cells/cell_module.hpp"

namespace raycell {

CellModule::CellModule(sc_core::sc_module_name name, Environment& environment, int x, int y)
    : sc_module(name),
      in("in", side_count),
      out("out", side_count),
      load_in("load_in"),
      environment_(environment),
      cell_(environment, x, y) {
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

void CellModule::end_of_elaboration() {
    for (int side = 0; side < side_count; ++side) {
        const auto i = std::size_t(side);
        LinkIn* link_in = in[i].size() > 0 ? in[i][0] : nullptr;
        LinkOut* link_out = out[i].size() > 0 ? out[i][0] : nullptr;
        cell_.connect(Side(side), link_in, link_out);
    }
    const auto west = std::size_t(Side::west);
    if (load_in.size() > 0) {
        cell_.connect_load(load_in[0]);
    } else if (in[west].size() > 0) {
        cell_.connect_load(in[west][0]);
    }
}

void CellModule::run() {
    const Cycle next = cell_.step(environment_.scheduler.now());
    if (next != never) environment_.scheduler.wake(*this, next);
}

}  // namespace raycell
