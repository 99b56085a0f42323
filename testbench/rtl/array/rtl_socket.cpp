#include "testbench/rtl/array/rtl_socket.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace raycell {
namespace {

using What = rtl::CellAct::What;

/// The link that a port is bound to; null at a border without one.
template <typename Interface>
Link* link_of(Interface* channel) {
    if (!channel) return nullptr;
    if (auto* link = dynamic_cast<Link*>(channel)) return link;
    throw std::logic_error("an RTL cell needs the array's own links; expected no other channels");
}

}  // namespace

RtlSocket::RtlSocket(sc_core::sc_module_name name, Environment& environment,
                     std::unique_ptr<rtl::ArrayCell> rtl, RtlFrom from, Disagreements& disagreements)
    : CellSocket(name),
      env_(environment),
      rtl_(std::move(rtl)),
      from_(from),
      disagreements_(disagreements),
      model_runs_(from == RtlFrom::trace) {
    SC_METHOD(run);
    sensitive << woken();
    dont_initialize();
    rtl_->reset("");
    look(0);
}

void RtlSocket::replaces(Cell& cell) {
    cell_ = &cell;
    cell.set_host(*this);
    books_ = std::make_unique<RtlBooks>(env_, cell, *rtl_, disagreements_);
}

/// The array's cell has the links, too: it runs until the RTL cell takes over, and reports look through it.
void RtlSocket::end_of_elaboration() {
    for (int side = 0; side < side_count; ++side) connect(Side(side));
    if (load_in.size() > 0) {
        Link* load = link_of(load_in[0]);
        cell_->connect_load(*load);
        if (model_runs_) load->connect_sink(*cell_);
    }
    cell_->elaborate();
}

void RtlSocket::connect(Side side) {
    if (Link* link = link_of(input(side))) {
        cell_->connect_in(side, *link);
        if (model_runs_) link->connect_sink(*cell_);
    }
    if (Link* link = link_of(output(side))) {
        cell_->connect_out(side, *link);
        if (model_runs_) link->connect_source(*cell_);
    }
}

void RtlSocket::begin_phase() {
    cell_->begin_phase();
    if (model_runs_ && env_.phase == Phase::trace) take_over();
    begins_ = true;
}

void RtlSocket::begin_tree(int pixel) {
    cell_->begin_tree(pixel);
    begins_ = true;
}

// ---- the RTL cell takes over

/// Between two phases all links are empty, so nothing is handed over but what was loaded.
void RtlSocket::take_over() {
    for (int side = 0; side < side_count; ++side) {
        Link* const links[] = {cell_->input(Side(side)), cell_->output(Side(side))};
        for (Link* link : links) {
            for (int index = 0; link && index < env_.classes.count; ++index) {
                if (link->occupancy(index) > 0) books_->fail("a message is on a link when it takes over");
            }
        }
        if (links[0]) links[0]->connect_sink(*this);
        if (links[1]) links[1]->connect_source(*this);
    }
    model_runs_ = false;
    rtl_->reset(books_->viewer_digits());
    load_store(cell_->store());
    look(env_.scheduler.now());
}

/// Writes the voxels that the model's cell has stored into the RTL cell.
void RtlSocket::load_store(const CellStore& store) {
    if (store.voxels.empty()) return;
    books_->fail(std::to_string(store.voxels.size()) +
                 " voxels lie here; expected none, because this RTL cell has no port to write them");
}

// ---- a cycle

void RtlSocket::run() {
    if (!model_runs_) return step();
    const Cycle next = cell_->step(env_.scheduler.now());
    if (next != never) env_.scheduler.wake(*cell_, next);
}

void RtlSocket::step() {
    catch_up();
    rtl_->begin(env_.scheduler.now());
    rtl_->phase(int(env_.phase), begins_);
    rtl_->drain(env_.draining);
    rtl_->settle();
    edge_ = env_.scheduler.now();
    const bool began = std::exchange(begins_, false);
    const std::string refusal = rtl_->refusal();
    if (!refusal.empty()) books_->fail(refusal);
    const std::vector<rtl::CellAct>& acts = rtl_->acts();
    for (const rtl::CellAct& act : acts) {
        count(act);
        books_->enter(act);
    }
    if (env_.phase != Phase::load) books_->end_cycle(acts);
    if (began) {  // what begins is in the registers after this cycle's edge
        env_.scheduler.wake(*this, edge_ + 1);
    } else {
        sleep_or_go_on(acts);
    }
}

/// What an act takes from the RTL cell's buffers and puts into those at the far ends.
void RtlSocket::count(const rtl::CellAct& act) {
    const bool leaves = act.what == What::load || act.what == What::answer || act.what == What::ray ||
                        act.what == What::reply;
    if (!leaves || act.waits) return;
    if (act.what != What::reply && act.place.side <= rtl::load_side)
        --given_[std::size_t(act.place.side)][std::size_t(act.place.index)];
    if (act.to < side_count) {
        const int index = rtl_->sent(act.to).index;
        if (index < 0 || index >= env_.classes.count)
            books_->fail("it sends in class " + std::to_string(index) + ", which is none");
        ++taken_[std::size_t(act.to)][std::size_t(index)];
    }
}

void RtlSocket::sleep_or_go_on(const std::vector<rtl::CellAct>& acts) {
    const bool acted = std::any_of(acts.begin(), acts.end(), [](const auto& act) { return !act.waits; });
    Wakeup wakeup;
    if (acted || !(rtl_->idle() || rtl_->still())) {
        wakeup.at(env_.scheduler.now() + 1);
    } else {
        for (const rtl::CellAct& act : acts) books_->ask_for_room(act, wakeup);
    }
    if (wakeup.next != never) env_.scheduler.wake(*this, wakeup.next);
}

// ---- the clock

/// Runs the edges up to this cycle's begin, with all that came in them.
void RtlSocket::catch_up() {
    const Cycle now = env_.scheduler.now();
    while (edge_ < now) {
        tell_arrivals();
        tell_free_places();
        rtl_->clock();
        if (edge_ + 1 == now) break;
        look(edge_ + 1);
        const auto& acts = rtl_->acts();
        if (std::any_of(acts.begin(), acts.end(), [](const auto& act) { return !act.waits; }))
            books_->fail("it acts in cycle " + std::to_string(edge_) + ", in which it had said to be still");
        if (rtl_->idle() || rtl_->still()) look(next_edge());
    }
}

/// Settles a cycle in which nothing is to happen.
void RtlSocket::look(Cycle cycle) {
    edge_ = cycle;
    rtl_->begin(cycle);
    rtl_->settle();
}

/// The next cycle in whose edge something comes, of a cell in which nothing happens before.
Cycle RtlSocket::next_edge() const {
    const Cycle now = env_.scheduler.now();
    Cycle next = now - 1;
    for (std::size_t side = 0; side <= rtl::load_side; ++side) {
        const Link* from = has_input(side) ? books_->input(int(side)) : nullptr;
        const Link* to = side < side_count ? cell_->output(Side(side)) : nullptr;
        for (int index = 0; index < env_.classes.count; ++index) {
            const int given = given_[side][std::size_t(index)];
            if (from && from->occupancy(index) > given)
                next = std::min(next, from->held(index, given).visible - 1);
            const int taken = taken_[side][std::size_t(index)];
            if (to && to->seen(index) < taken) next = std::min(next, now - Cycle(taken - to->seen(index)));
        }
    }
    return std::max(next, edge_);
}

/// Messages that can be seen from the next cycle on.
void RtlSocket::tell_arrivals() {
    for (std::size_t side = 0; side <= rtl::load_side; ++side) {
        const Link* link = has_input(side) ? books_->input(int(side)) : nullptr;
        for (int index = 0; link && index < env_.classes.count; ++index) {
            int& given = given_[side][std::size_t(index)];
            if (link->occupancy(index) <= given) continue;
            const Link::Held held = link->held(index, given);
            if (held.visible > edge_ + 1) continue;
            if (held.visible <= edge_)
                books_->fail("a message of cycle " + std::to_string(held.visible) + " comes too late");
            rtl_->arrives(int(side), index, books_->digits_of(held.message), RtlBooks::id_of(held.message));
            ++given;
        }
    }
}

/// One place of a class can be told in each edge. They are told in the last ones: a cell that waits for room
/// is woken by the first place, and must not know of it before.
void RtlSocket::tell_free_places() {
    const Cycle left = env_.scheduler.now() - edge_;  // edges
    for (std::size_t side = 0; side < side_count; ++side) {
        const Link* link = cell_->output(Side(side));
        for (int index = 0; link && index < env_.classes.count; ++index) {
            int& taken = taken_[side][std::size_t(index)];
            if (Cycle(std::max(taken - link->seen(index), 0)) < left) continue;
            rtl_->frees(int(side), index);
            --taken;
        }
    }
}

}  // namespace raycell
