// A verilated cell in the running array.
//
// All that an RTL cell does in a cycle follows from its registers. So the edge that ends a cycle is put off
// until the cell is woken again: by then it is known what arrived in it and which places were freed. A cell
// in which nothing can happen sleeps, and its clock is set on to the cycle before it is woken.
#pragma once

#include <array>
#include <memory>

#include "cells/hosts/cell_socket.hpp"
#include "testbench/rtl/array/books.hpp"

namespace raycell {

/// Who loads a cell: the RTL cell itself, or the array's cell of its place, which also runs phase precast.
enum class RtlFrom { load, trace };

class RtlSocket : public CellSocket, private CellHost {
  public:
    SC_HAS_PROCESS(RtlSocket);
    /// `disagreements` must outlive it.
    RtlSocket(sc_core::sc_module_name name, Environment& environment, std::unique_ptr<rtl::ArrayCell> rtl,
              RtlFrom from, Disagreements& disagreements);

    void replaces(Cell& cell) override;
    void begin_phase() override;
    void begin_tree(int pixel) override;

  private:
    using Count = std::array<std::array<int, Link::most_classes>, side_count + 1>;  ///< by side and class

    void end_of_elaboration() override;
    void connect(Side side);
    void run();
    void step();
    // The clock.
    void catch_up();
    void tell_arrivals();
    void tell_free_places();
    Cycle next_edge() const;
    /// In the first column load messages have a link of their own, elsewhere they come from the west.
    bool has_input(std::size_t side) const { return side < rtl::load_side || cell_->x() == 0; }
    void look(Cycle cycle);
    void sleep_or_go_on(const std::vector<rtl::CellAct>& acts);
    void count(const rtl::CellAct& act);
    // From the model's cell to the RTL cell.
    void take_over();
    void load_store(const CellStore& store);
    void activate(Cell&) override { CellSocket::activate(); }

    Environment& env_;
    std::unique_ptr<rtl::ArrayCell> rtl_;
    const RtlFrom from_;
    Disagreements& disagreements_;
    Cell* cell_ = nullptr;
    std::unique_ptr<RtlBooks> books_;
    bool model_runs_;      ///< the array's cell, not the RTL cell
    bool begins_ = false;  ///< the next cycle is a phase's first, or an own ray's
    Cycle edge_ = 0;       ///< the cycle whose edge is still to come
    Count given_{};        ///< messages that are in the RTL cell's buffers
    Count taken_{};        ///< places at the far ends that the RTL cell knows to be taken
};

}  // namespace raycell
