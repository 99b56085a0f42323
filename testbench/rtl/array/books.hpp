// The books of an RTL cell in the array: what it does becomes messages on the model's links, and is counted
// as the model's cell counts it. The model also says what each message should have been.
#pragma once

#include <array>

#include "cells/cell.hpp"
#include "model/machine/load_wire.hpp"
#include "model/machine/wire.hpp"
#include "testbench/golden/packing.hpp"
#include "testbench/rtl/array/disagreements.hpp"
#include "testbench/rtl/array/rtl_cell.hpp"

namespace raycell {

/// Statistics, the schedule's hash and the own pixel are kept in the array's cell of the same place, `cell`,
/// whose links must be connected. Rays and answers are told apart by what the RTL cell says of its places, so
/// an id needs no wire.
class RtlBooks {
  public:
    RtlBooks(Environment& environment, Cell& cell, rtl::ArrayCell& rtl, Disagreements& disagreements);

    /// Does what the RTL cell did in this cycle. Throws std::runtime_error for what no link can do.
    void enter(const rtl::CellAct& act);
    /// Bits of a message for the RTL cell.
    std::string digits_of(const Message& message) const;
    std::string viewer_digits() const;
    /// What no wire carries of a message: the id of its ray, 0 for a load message.
    static std::uint64_t id_of(const Message& message);
    /// The link from which a side's messages come; rtl::load_side: load messages of the first column.
    Link* input(int side) const {
        return side < rtl::load_side ? cell_.input(Side(side)) : cell_.load_input();
    }
    /// After the acts of a cycle: whether anything moved or was held up.
    void end_cycle(const std::vector<rtl::CellAct>& acts);
    /// Has the links wake the cell when there is room for a message that waits.
    void ask_for_room(const rtl::CellAct& act, Wakeup& wakeup);
    void disagree(const std::string& text);
    [[noreturn]] void fail(const std::string& text) const;

  private:
    void load(const rtl::CellAct& act);
    void loaded();
    void launch();
    void launch_child(int slot);
    Ray next_child(Slot& slot);
    void test(const rtl::CellPlace& place);
    void move_answer(const rtl::CellAct& act);
    void move_ray(const rtl::CellAct& act);
    void forward(RayPacket& packet, const rtl::CellAct& act);
    void respond(RayPacket& packet, const rtl::CellAct& act);
    void send(Answer& answer, int side);
    void deliver(const Answer& answer);
    void deliver_to_slot(const Answer& answer);
    void accept(RayPacket& packet, const rtl::CellAct& act);
    void postpone(RayPacket& packet, const rtl::CellAct& act);
    void begin_job(const rtl::CellAct& act);
    void end_job(const rtl::CellAct& act);
    void reply(const rtl::CellAct& act);
    void leave(const Answer& answer, int to);
    Slot& slot_at(int index) const;
    void wait_for_slot(RayPacket& packet, const rtl::CellAct& act);
    void wait(Wait& wait, std::uint64_t ray, const rtl::CellAct& act, bool answer);

    RayPacket& packet_at(const rtl::CellPlace& place) const;
    void remove_from(const rtl::CellPlace& place);
    /// What goes out over a side, once it is sure that the link can take it, with a check of its length.
    rtl::CellMessage outgoing(int side, int index, int cycles);
    std::uint64_t id_of(const rtl::CellMessage& sent, std::uint64_t of_place) const;
    static WireBits bits_of(const rtl::CellMessage& sent);
    static std::string goal_name(int to);
    void compare(const Message& expected, const rtl::CellMessage& sent);
    void stall(Wait& wait, Stall cause, std::uint64_t ray);
    void settle(const Wait& wait, std::uint64_t ray);
    void record(CellEvent event, std::uint32_t hashed, std::uint64_t ray, std::uint32_t detail);
    void tell(CellEvent event, std::uint64_t ray, std::uint32_t detail) const;
    Cycle now() const { return env_.scheduler.now(); }

    Environment& env_;
    Cell& cell_;
    rtl::ArrayCell& rtl_;
    Disagreements& disagreements_;
    Packing packing_;
    Words words_;
    Wire wire_;
    LoadWire load_wire_;
    std::array<Wait, side_count> answer_waits_{};
    Cycle port_used_ = never;  ///< cycle of the last answer that came home
};

}  // namespace raycell
