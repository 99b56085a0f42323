#include "testbench/loading/watch.hpp"

#include <algorithm>

#include "model/machine/feed_bits.hpp"

namespace raycell::loading {
namespace {

using Kind = LoadItem::Kind;

std::string words_of(const LoadItem& item) {
    switch (item.kind) {
        case Kind::setup:
            return "sources and viewer";
        case Kind::features:
            return "features of object " + std::to_string(item.object);
        case Kind::polygon:
            return "polygon " + std::to_string(item.polygon.id);
        case Kind::surface:
            return "surface of polygon " + std::to_string(item.trapeze.polygon);
        case Kind::trapeze:
            return "trapeze of polygon " + std::to_string(item.trapeze.polygon);
        case Kind::span:
            return "span of polygon " + std::to_string(item.span.polygon);
        case Kind::end_of_scene:
            break;
    }
    return "end-of-scene mark";
}

}  // namespace

LoadWatch::LoadWatch(const LoadPlan& plan, const MachineSettings& machine)
    : plan_(plan),
      layout_(plan.layout),
      machine_(machine),
      costs_(machine.costs),
      links_(layout_.links()),
      units_(layout_.units()),
      link_use_(layout_.links()),
      use_(layout_.units()),
      dropped_(std::size_t(layout_.height)) {
    for (LinkUse& use : link_use_) use.depth = machine.buffer_depth;
    for (int lane = 0; lane < layout_.lanes; ++lane)
        link_use_[layout_.polygons(lane)].depth = link_use_[layout_.trapezes(lane)].depth = feed_link_depth;
}

std::string LoadWatch::at(std::size_t link, Cycle now) const {
    return "link " + layout_.link_name(link) + " in cycle " + std::to_string(now) + ": ";
}

std::string LoadWatch::in(std::size_t unit, Cycle now) const {
    return layout_.unit_name(unit) + " in cycle " + std::to_string(now) + ": ";
}

bool LoadWatch::makes_voxel(std::size_t unit, const LoadItem& item) const {
    return layout_.unit_group(unit) == UnitGroup::cells && item.kind == Kind::span &&
           item.span.x == layout_.unit_place(unit).x;
}

std::uint32_t LoadWatch::work_at(std::size_t unit, const LoadItem& item) const {
    const Layout::Place place = layout_.unit_place(unit);
    switch (layout_.unit_group(unit)) {
        case UnitGroup::distributors: {
            const bool cuts = item.kind == Kind::trapeze && place.y >= item.trapeze.rows.first;
            return cuts ? costs_.distribution_span : costs_.distribution_pass;
        }
        case UnitGroup::cells:
            return makes_voxel(unit, item) ? costs_.load_advance : costs_.load_forward;
        case UnitGroup::geometry:
        case UnitGroup::precomputation:
            break;
    }
    return 0;
}

void LoadWatch::sent(std::size_t link, const LoadItem& item, int cycles, Cycle now) {
    LinkState& state = links_[link];
    LinkUse& use = link_use_[link];
    std::uint64_t ticket = 0;
    const std::size_t source = layout_.source_of(link);
    const int lane = layout_.unit_lane(source);
    switch (layout_.unit_group(source)) {
        case UnitGroup::geometry:
            compare(link, plan_.lanes[std::size_t(lane)].polygons, item);
            ticket = leave_geometry(lane, now);
            break;
        case UnitGroup::precomputation:
            compare(link, plan_.lanes[std::size_t(lane)].trapezes, item);
            ticket = leave_precomputation(lane, item, now);
            break;
        case UnitGroup::distributors:
            ticket = leave_distributor(link, item, now);
            break;
        case UnitGroup::cells:
            ticket = leave_cell(link, item, now);
            break;
    }
    if (ticket < state.next_ticket)
        order_.add(at(link, now) + words_of(item) + " goes after a later message");
    state.next_ticket = ticket + 1;
    const Cycle arrival = now + Cycle(cycles);
    const std::size_t sink = layout_.sink_of(link);
    state.held.push_back({&item, ticket, now, arrival, work_at(sink, item), makes_voxel(sink, item)});
    state.wires_free = arrival;
    ++use.sent;
    use.wire_cycles += std::uint64_t(cycles);
    // A place that is freed in this cycle still counts, as it does for the sender.
    const int still_seen = state.last_pop == now ? state.popped_now : 0;
    use.peak = std::max(use.peak, int(state.held.size()) + still_seen);
    if (use.peak > use.depth) order_.add(at(link, now) + "more messages than places");
    use.first_arrival = std::min(use.first_arrival, arrival);
    use.last_arrival = std::max(use.last_arrival, arrival);
}

void LoadWatch::compare(std::size_t link, const std::vector<std::uint64_t>& planned, const LoadItem& item) {
    const std::uint64_t place = link_use_[link].sent;
    if (place < planned.size() && planned[place] == digest_of(item)) return;
    content_.add("link " + layout_.link_name(link) + ", message " + std::to_string(place) + " of " +
                 std::to_string(planned.size()) + " (from 0): the " + words_of(item) +
                 " is not what untimed loading sends there");
}

void LoadWatch::leave(std::size_t link, std::size_t output, Cycle ready, Cycle now) {
    LinkState& state = links_[link];
    Cycle room = 0;
    if (link_use_[link].sent >= std::uint64_t(link_use_[link].depth) && !state.room.empty()) {
        room = state.room.front() + 1;
        state.room.erase(state.room.begin());
    }
    const Cycle first = std::max({ready, room, state.wires_free});
    if (now != first) {
        promptness_.add(at(link, now) + "a message leaves; it could in cycle " + std::to_string(first));
    }
    if (now <= ready) return;
    OutputWait& wait = use_[layout_.source_of(link)].waits[output];
    const Cycle full = std::min(std::max(room, ready), now) - ready;
    wait.full += full;
    wait.busy += now - ready - full;
}

std::uint64_t LoadWatch::leave_geometry(int lane, Cycle now) {
    const std::size_t index = layout_.geometry(lane);
    UnitState& unit = units_[index];
    UnitUse& use = use_[index];
    const std::vector<std::uint32_t>& works = plan_.lanes[std::size_t(lane)].geometry_work;
    const std::uint64_t place = use.messages++;
    const std::uint32_t work = place < works.size() ? works[place] : 0;
    const Cycle ready = unit.begin + work;
    use.busy_cycles += work;
    leave(layout_.polygons(lane), 0, ready, now);
    if (now > ready) use.blocked_cycles += now - ready;
    unit.begin = now + 1;
    return place;
}

std::uint64_t LoadWatch::leave_precomputation(int lane, const LoadItem& item, Cycle now) {
    const std::size_t index = layout_.precomputation(lane);
    const std::size_t link = layout_.trapezes(lane);
    UnitState& unit = units_[index];
    UnitUse& use = use_[index];
    const bool trapeze = item.kind == Kind::trapeze;
    const Cycle ready = unit.begin + (trapeze ? costs_.precomputation_trapeze : 1);
    if (trapeze) use.busy_cycles += costs_.precomputation_trapeze;
    leave(link, 0, ready, now);
    if (now > ready) use.blocked_cycles += now - ready;
    unit.begin = unit.last_send = now + 1;
    return link_use_[link].sent;
}

void LoadWatch::begin_work(std::size_t index, const Held& head) {
    UnitState& unit = units_[index];
    UnitUse& use = use_[index];
    const Cycle begin = std::max(unit.begin, head.arrival);
    use.starved_cycles += begin - unit.begin;
    use.busy_cycles += head.work;
    unit.ready = unit.last_send = begin + head.work;
    unit.works = true;
    ++use.messages;
}

std::uint64_t LoadWatch::leave_distributor(std::size_t link, const LoadItem& item, Cycle now) {
    const std::size_t index = layout_.source_of(link);
    const std::vector<Held>& input = links_[layout_.input_of(index)].held;
    if (input.empty()) {
        order_.add(at(link, now) + words_of(item) + " leaves a distributor that has taken nothing");
        return links_[link].next_ticket;
    }
    UnitState& unit = units_[index];
    if (!unit.works) begin_work(index, input.front());
    unit.last_send = std::max(unit.last_send, now);
    const bool down = layout_.link_group(link) == LinkGroup::down;
    leave(link, down ? 1 : 0, unit.ready, now);
    if (!down) {
        compare(link, plan_.rows[std::size_t(layout_.unit_place(index).y)], item);
        return link_use_[link].sent;
    }
    if (input.front().item != &item)
        order_.add(at(link, now) + words_of(item) + " goes down out of its turn");
    return input.front().ticket;
}

std::uint64_t LoadWatch::leave_cell(std::size_t link, const LoadItem& item, Cycle now) {
    const std::size_t index = layout_.source_of(link);
    UnitState& unit = units_[index];
    if (unit.held != &item || unit.taken != now) {
        order_.add(at(link, now) + words_of(item) + " leaves a cell that has not taken it in this cycle");
    }
    leave(link, 0, std::max(unit.ready, unit.room), now);
    if (now > unit.ready) use_[index].blocked_cycles += now - unit.ready;
    unit.held = nullptr;
    return unit.ticket;
}

void LoadWatch::popped(std::size_t link, const LoadItem& item, Cycle now) {
    LinkState& state = links_[link];
    LinkUse& use = link_use_[link];
    if (state.held.empty()) {
        order_.add(at(link, now) + words_of(item) + " comes out and never went in");
        return;
    }
    const Held held = state.held.front();
    if (held.item != &item) order_.add(at(link, now) + words_of(item) + " comes out of its turn");
    if (now < held.arrival) order_.add(at(link, now) + words_of(item) + " is taken before it has arrived");
    const std::size_t sink = layout_.sink_of(link);
    switch (layout_.unit_group(sink)) {
        case UnitGroup::geometry:
            break;  // reads no link
        case UnitGroup::precomputation:
            take_into_precomputation(sink, held, now);
            break;
        case UnitGroup::distributors:
            take_into_distributor(sink, held, now);
            break;
        case UnitGroup::cells:
            take_into_cell(sink, held, now);
            break;
    }
    state.held.erase(state.held.begin());
    state.room.push_back(now);
    if (state.last_pop != now) state.popped_now = 0;
    state.last_pop = now;
    ++state.popped_now;
    ++use.delivered;
    use.occupied_cycles += now - held.sent;
}

void LoadWatch::take_into_precomputation(std::size_t index, const Held& held, Cycle now) {
    UnitState& unit = units_[index];
    UnitUse& use = use_[index];
    // A polygon without a trapeze takes only the cycle in which it was read.
    const Cycle free = unit.taken == never ? unit.begin : std::max(unit.last_send, unit.taken + 1);
    const Cycle first = std::max(free, held.arrival);
    if (now != first) {
        promptness_.add(in(index, now) + "takes a message; it could in cycle " + std::to_string(first));
    }
    if (now > free) use.starved_cycles += now - free;
    ++use.messages;
    unit.begin = unit.taken = now;
}

void LoadWatch::take_into_distributor(std::size_t index, const Held& held, Cycle now) {
    UnitState& unit = units_[index];
    if (!unit.works) begin_work(index, held);
    const Cycle first = std::max(unit.ready, unit.last_send);
    if (now != first) {
        promptness_.add(in(index, now) + "is done with a message; it could be in cycle " +
                        std::to_string(first));
    }
    if (now > unit.ready) use_[index].blocked_cycles += now - unit.ready;
    unit.works = false;
    unit.begin = now + 1;
}

void LoadWatch::take_into_cell(std::size_t index, const Held& held, Cycle now) {
    UnitState& unit = units_[index];
    const Layout::Place place = layout_.unit_place(index);
    const LoadItem& item = *held.item;
    if (unit.held) conservation_.add(in(index, now) + "has not passed on what it took before");
    begin_work(index, held);
    unit.room = 0;
    if (held.makes_voxel) keep_span(index, now);
    const bool drops = item.kind == Kind::span ? item.span.last == place.x : place.x + 1 == layout_.width;
    if (drops) {
        ++dropped_[std::size_t(place.y)];
        const Cycle first = std::max(unit.ready, unit.room);
        if (now != first) {
            promptness_.add(in(index, now) + "is done with a message; it could be in cycle " +
                            std::to_string(first));
        }
        if (now > unit.ready) use_[index].blocked_cycles += now - unit.ready;
    } else {
        unit.held = &item;
    }
    unit.ticket = held.ticket;
    unit.taken = now;
    unit.begin = now + 1;
    latch(index, item, now);
}

/// The span moves on once the cell has a place for it; its voxel is begun once one of the cell's units is
/// free.
void LoadWatch::keep_span(std::size_t index, Cycle now) {
    UnitState& unit = units_[index];
    UnitUse& use = use_[index];
    const Cycle each = plan_.voxel_cycles;
    std::vector<Cycle>& kept = unit.kept;
    // The cycle in which no more than `left` of the spans kept are left.
    const auto until = [&](int left) {
        return kept.size() > std::size_t(left) ? kept[kept.size() - std::size_t(left) - 1] : 0;
    };
    if (machine_.load_queue > 0) unit.room = until(machine_.load_queue - 1);
    if (unit.room > unit.ready) use.queue_full += std::min(unit.room, now) - std::min(unit.ready, now);
    const Cycle begins = std::max(now, until(machine_.loading_units - 1));
    kept.push_back(begins + each);
    kept.erase(kept.begin(), std::upper_bound(kept.begin(), kept.end(), now));
    const std::uint32_t lines = plan_.lines[index - layout_.cell(0, 0)][use.spans];
    if (lines > 0) unit.ordered = std::max(unit.ordered, begins + each) + Cycle(lines) * costs_.load_order;
    unit.made = std::max({now, kept.empty() ? now : kept.back(), unit.ordered});
    use.making += each;
    ++use.spans;
    use.most_kept = std::max(use.most_kept, std::uint64_t(kept.size()));
}

void LoadWatch::latch(std::size_t index, const LoadItem& item, Cycle now) {
    UnitState& unit = units_[index];
    if (unit.finished) order_.add(in(index, now) + words_of(item) + " follows the end-of-scene mark");
    if (!unit.set_up && item.kind != Kind::setup) {
        order_.add(in(index, now) + words_of(item) + " comes before sources and viewer");
    }
    switch (item.kind) {
        case Kind::setup:
            unit.set_up = true;
            break;
        case Kind::features:
            unit.object = item.object;
            break;
        case Kind::span:
            if (item.span.object != unit.object) {
                order_.add(in(index, now) + words_of(item) + " comes without the features of object " +
                           std::to_string(item.span.object));
            }
            break;
        case Kind::end_of_scene:
            unit.finished = true;
            loaded_ = std::max({loaded_, now, unit.made});
            break;
        case Kind::polygon:
        case Kind::surface:
        case Kind::trapeze:
            order_.add(in(index, now) + words_of(item) + " does not belong into a row");
            break;
    }
}

void LoadWatch::finish_link(std::size_t index) {
    const LinkUse& use = link_use_[index];
    const Need& need = plan_.links[index];
    const std::string name = "link " + layout_.link_name(index) + ": ";
    if (use.sent != use.delivered) {
        conservation_.add(name + std::to_string(use.sent) + " sent, " + std::to_string(use.delivered) +
                          " delivered");
    }
    if (use.sent != need.messages) {
        content_.add(name + std::to_string(use.sent) + " messages, untimed loading sends " +
                     std::to_string(need.messages));
    } else if (use.wire_cycles < need.cycles || (machine_.stall == 0 && use.wire_cycles > need.cycles)) {
        content_.add(name + std::to_string(use.wire_cycles) + " cycles on the wires, its messages take " +
                     std::to_string(need.cycles));
    }
}

void LoadWatch::finish_unit(std::size_t index) {
    const Need& need = plan_.units[index];
    const UnitUse& use = use_[index];
    const std::string name = layout_.unit_name(index) + ": ";
    if (use.messages != need.messages || use.busy_cycles != need.cycles) {
        content_.add(name + std::to_string(use.messages) + " messages, " + std::to_string(use.busy_cycles) +
                     " cycles of work; untimed loading makes them " + std::to_string(need.messages) +
                     " and " + std::to_string(need.cycles));
    }
    if (use.making != need.making) {
        content_.add(name + std::to_string(use.making) + " cycles of making voxels, untimed loading takes " +
                     std::to_string(need.making));
    }
    if (layout_.unit_group(index) != UnitGroup::cells) return;
    if (units_[index].held) conservation_.add(name + "has not passed on what it took last");
    if (!units_[index].finished) order_.add(name + "has seen no end-of-scene mark");
}

void LoadWatch::finish() {
    for (std::size_t i = 0; i < layout_.links(); ++i) {
        if (!layout_.absent(i)) finish_link(i);
    }
    for (std::size_t i = 0; i < layout_.units(); ++i) finish_unit(i);
    for (int y = 0; y < layout_.height; ++y) {
        const std::uint64_t sent = link_use_[layout_.row(y)].sent;
        const std::uint64_t dropped = dropped_[std::size_t(y)];
        if (sent != dropped) {
            conservation_.add("row " + std::to_string(y) + ": " + std::to_string(sent) +
                              " messages sent into it, " + std::to_string(dropped) + " dropped at their end");
        }
    }
}

void LoadWatch::finish_at(Cycle load_cycles) {
    if (load_cycles == loaded_) return;
    promptness_.add("loading is over in cycle " + std::to_string(load_cycles) +
                    "; its last cell is loaded in cycle " + std::to_string(loaded_));
}

}  // namespace raycell::loading
