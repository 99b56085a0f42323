#include "pipeline/stages/distribution.hpp"

#include <algorithm>

#include "cells/channels/split_link.hpp"
#include "pipeline/stages/feed_lane.hpp"

namespace raycell {
namespace {

std::string name_down(int y) { return "distribution.row_" + std::to_string(y) + ".down"; }

}  // namespace

void RowDistributor::take(LoadItem& item, Cycle now) {
    Environment& env = environment();
    item_ = &item;
    passed_on_ = false;
    const bool last_row = down == nullptr;
    Cycle cycles = env.costs().distribution_pass;
    if (item.kind == LoadItem::Kind::surface) {
        surface_ = item.trapeze;
        goes_down_ = !last_row && surface_.last_row > row_;
    } else if (item.kind == LoadItem::Kind::trapeze) {
        static_cast<Surface&>(item.trapeze) = surface_;
        goes_down_ = !last_row && item.trapeze.reaches_below(row_);
        const bool gouraud = env.context.settings.display == Display::gouraud;
        if (row_ >= item.trapeze.rows.first) {
            cycles = env.costs().distribution_span;
            auto span = cut_span(item.trapeze, row_, env.context.scene.frame.depth, env.context.settings.hit,
                                 env.context.arithmetic, gouraud ? &item.intensities : nullptr);
            if (span) {
                to_row_ = env.pools.loads.take();
                to_row_->kind = LoadItem::Kind::span;
                to_row_->span = *span;
                ++statistics_.items;
            }
        }
    } else {
        goes_down_ = !last_row;
        to_row_ = env.pools.loads.take();
        to_row_->kind = item.kind;
        to_row_->object = item.object;
    }
    work(now, cycles);
    ready_ = now + cycles;
}

Cycle RowDistributor::step(Cycle now) {
    Environment& env = environment();
    Cycle retry = never;
    if (!item_) {
        const Message message = in->front(0);
        if (message.kind != Message::Kind::load) return never;
        take(*message.load, now);
    }
    if (now < ready_) return ready_;
    if (to_row_ && east->can_send(0, retry)) {
        ++env.meters.counters.loads_sent;
        send_load(*east, *to_row_, env);
        to_row_ = nullptr;
    }
    if (goes_down_ && down->can_send(0, retry)) {
        send_feed(*down, *item_, env);
        goes_down_ = false;
        passed_on_ = true;
    }
    if (to_row_ || goes_down_) return retry;
    if (!passed_on_) env.pools.loads.give_back(item_);
    in->pop(0);
    item_ = nullptr;
    return now + 1;
}

Distribution::Distribution(sc_core::sc_module_name name, Environment& environment)
    : sc_module(name), share_(environment.share) {
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
    for (const int y : share_.rows())
        rows_.push_back(std::make_unique<RowDistributor>(environment, y, active_, wake_));
    for (int lane = 0; lane < environment.feed_lanes(); ++lane)
        lane_starts_.push_back(rows_of_lane(lane, environment.feed_lanes(), environment.height()).first);
    for (const Band& band : share_.bands()) {
        for (int y = band.first; y < band.end; ++y) {
            if (!begins_lane(y)) join_above(environment, y, y == band.first ? band.above : nullptr);
        }
        if (band.below && !begins_lane(band.end)) join_below(environment, band.end - 1, *band.below);
    }
}

bool Distribution::begins_lane(int y) const {
    return std::binary_search(lane_starts_.begin(), lane_starts_.end(), y);
}

void Distribution::run() {
    for (RowDistributor* row : active_) row->run();
    active_.clear();
}

/// Makes the link into the distributor of row y; a half link if the row above is another rank's.
void Distribution::join_above(Environment& environment, int y, SplitLinks* above) {
    links_.push_back(std::make_unique<Link>(environment.scheduler, 1, environment.machine.buffer_depth));
    Link& link = *links_.back();
    link.set_name(name_down(y - 1));
    link.connect_sink(row(y));
    row(y).in = &link;
    if (above) {
        above->add_sink(link);
        return;
    }
    environment.stall(link, link.name());
    link.connect_source(row(y - 1));
    row(y - 1).down = &link;
}

/// Makes the half link from the distributor of row y to another rank's.
void Distribution::join_below(Environment& environment, int y, SplitLinks& below) {
    Link& link = below.make_source(environment.scheduler, 1, environment.machine.buffer_depth);
    link.set_name(name_down(y));
    environment.stall(link, link.name());
    link.connect_source(row(y));
    row(y).down = &link;
}

StageStatistics Distribution::statistics() const {
    StageStatistics sum;
    for (const auto& row : rows_) sum += row->statistics();
    return sum;
}

std::size_t Distribution::holds() const {
    std::size_t sum = 0;
    for (const auto& link : links_) sum += std::size_t(link->occupancy(0));
    for (const auto& row : rows_) {
        sum += row->holds();
        sum -= row->works_on_what_it_passed_on() ? 1 : 0;
    }
    return sum;
}

}  // namespace raycell
