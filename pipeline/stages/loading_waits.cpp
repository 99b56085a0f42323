// The wait-for graph during loading: what load messages wait for. Messages only move down the pipeline, so
// something always moves; the graph shows what the others wait for.
#include "cells/deadlock/cell_waits.hpp"
#include "pipeline/stages/distribution.hpp"
#include "pipeline/stages/geometry.hpp"
#include "pipeline/stages/precomputation.hpp"

namespace raycell {
namespace {

using Kind = WaitGraph::Kind;

WaitGraph::Node place(Kind kind, int y, std::string what) {
    WaitGraph::Node node;
    node.kind = kind;
    node.y = y;
    node.what = std::move(what);
    return node;
}

void add_stage(WaitMap& map, const StageWork& stage, int y, const char* what, const LoadItem& item,
               Cycle since) {
    WaitGraph::Node node = place(Kind::stage, y, what);
    node.holds = describe(item);
    node.since = since;
    map.add(&stage, 0, std::move(node));
}

/// What a message in a stage waits for; it is ready to leave in cycle `ready`.
Wants wants_out(const WaitMap& map, Cycle now, Cycle ready, const Link& out, const char* name) {
    return now < ready ? Wants::nothing("the end of its work") : wants_buffer(map, out, 0, name);
}

/// Sets what the message at the head of a link waits for: the stage `taker`, and the message that it may
/// hold.
void set_input(WaitMap& map, const Link& in, const StageWork& taker) {
    const auto node = map.find(&in, Kind::buffer, 0);
    if (!node) return;
    if (in.front(0).kind == Message::Kind::none) {
        map.set(*node, Wants::nothing("its arrival"));
        return;
    }
    const auto stage = map.find(&taker, Kind::stage, 0);
    map.set(*node, stage ? Wants{false, false, {*stage}, "the stage"} : Wants::nothing("the stage"));
}

const Link& link_of(const sc_core::sc_port_b<LinkOut>& out) {
    return static_cast<const Link&>(*out.operator->());
}

}  // namespace

void RowDistributor::add_places(WaitMap& map) const {
    add_buffer(map, *in, 0, place(Kind::buffer, row_, "input of the row's distributor"));
    if (to_row_) add_stage(map, *this, row_, "the row's distributor", *to_row_, ready_);
    add_buffer(map, *east, 0, place(Kind::buffer, row_, "input of the row's first cell"));
}

void RowDistributor::add_waits(WaitMap& map) const {
    const Cycle now = environment().scheduler.now();
    const auto stage = map.find(static_cast<const StageWork*>(this), Kind::stage, 0);
    if (stage) map.set(*stage, wants_out(map, now, ready_, *east, "the row's first cell"));
    const auto node = map.find(in, Kind::buffer, 0);
    if (!node) return;
    if (!item_ || now < ready_) {
        map.set(*node, Wants::nothing(item_ ? "the end of the distributor's work" : "its arrival"));
        return;
    }
    // The message stays until both its span and the message itself have left.
    Wants wants{false, true, {}, ""};
    if (stage) {
        wants.on.push_back(*stage);
        wants.text = "its span to leave";
    }
    if (goes_down_) {
        const Wants below = wants_buffer(map, *down, 0, "the row below");
        wants.on.insert(wants.on.end(), below.on.begin(), below.on.end());
        wants.text += (wants.text.empty() ? "" : ", ") + below.text;
    }
    wants.moves = wants.on.empty();
    map.set(*node, std::move(wants));
}

void Geometry::add_places(WaitMap& map) const {
    if (item_) add_stage(map, *this, rows_.first, "geometry", *item_, ready_);
}

void Geometry::add_waits(WaitMap& map) const {
    const Cycle now = environment().scheduler.now();
    if (const auto node = map.find(static_cast<const StageWork*>(this), Kind::stage, 0))
        map.set(*node, wants_out(map, now, ready_, link_of(out), "precomputation"));
}

void Precomputation::add_places(WaitMap& map, const Link& input) const {
    add_buffer(map, input, 0, place(Kind::buffer, rows_.first, "input of precomputation"));
    if (item_) add_stage(map, *this, rows_.first, "precomputation", *item_, ready_);
}

void Precomputation::add_waits(WaitMap& map, const Link& input) const {
    set_input(map, input, *this);
    const Cycle now = environment().scheduler.now();
    if (const auto node = map.find(static_cast<const StageWork*>(this), Kind::stage, 0))
        map.set(*node, wants_out(map, now, ready_, link_of(out), "the first row's distributor"));
}

}  // namespace raycell
