#include "pipeline/ranks/rank_exchange.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>

#include "cells/clock/wall_time.hpp"

namespace raycell {
void RankProgress::join(const RankProgress& other) {
    next = std::min(next, other.next);
    last_progress = std::max(last_progress, other.last_progress);
    rays_destroyed += other.rays_destroyed;
    done += other.done;
    hops += other.hops;
    interrupted = std::max(interrupted, other.interrupted);
}

std::vector<int> even_bands(int ranks, int height) {
    constexpr int most = 8;   ///< bands per rank: more do not balance a cycle better
    constexpr int least = 4;  ///< rows per band, if a rank has more than one band
    if (ranks > height) {
        throw std::invalid_argument(std::to_string(ranks) + " ranks for " + std::to_string(height) +
                                    " rows of cells; expected a row for each at least");
    }
    const int bands = ranks * std::clamp(height / ranks / least, 1, most);
    std::vector<int> rows;
    for (int i = 0; i <= bands; ++i) rows.push_back(int(std::int64_t(height) * i / bands));
    return rows;
}

RankExchange::RankExchange(RankTransport& transport, std::vector<int> bands, bool with_exterior)
    : transport_(transport), bands_(std::move(bands)), share_(0) {
    make_peers(with_exterior);
    share_ = ArrayShare(bands_.back(), own_bands());
    for (const Peer& peer : peers_) {
        parcels_.emplace_back();
        parcels_.back().rank = peer.rank;
    }
    short_out_.resize(sizeof(RankProgress));
}

void RankExchange::make_peers(bool with_exterior) {
    std::set<int> others;
    for (int band = 1; band < bands(); ++band) {
        if (band % count() == rank()) others.insert((band - 1) % count());
        if ((band - 1) % count() == rank()) others.insert(band % count());
    }
    for (int other = 0; with_exterior && other < count(); ++other) {
        if (other == 0 || rank() == 0) others.insert(other);
    }
    others.erase(rank());
    for (const int other : others) {
        peers_.push_back({other, std::make_unique<SplitLinks>()});
        peers_.back().links->set_prefix(sizeof(RankProgress));
    }
}

std::vector<Band> RankExchange::own_bands() {
    std::vector<Band> own;
    for (int band = rank(); band < bands(); band += count()) {
        own.push_back({first_row(band), first_row(band + 1), nullptr, nullptr});
        if (band > 0) own.back().above = links_to((band - 1) % count());
        if (band + 1 < bands()) own.back().below = links_to((band + 1) % count());
    }
    return own;
}

int RankExchange::band_of(int y) const {
    return int(std::upper_bound(bands_.begin(), bands_.end(), y) - bands_.begin()) - 1;
}

SplitLinks* RankExchange::links_to(int other) {
    const auto found =
        std::find_if(peers_.begin(), peers_.end(), [&](const Peer& peer) { return peer.rank == other; });
    return found == peers_.end() ? nullptr : found->links.get();
}

/// Swaps progress with all peers and, if `with_links`, the records of the half links.
void RankExchange::carry(const RankProgress& mine, bool with_links) {
    for (std::size_t i = 0; i < peers_.size(); ++i) {
        Bytes& out = with_links ? peers_[i].links->out() : short_out_;
        std::memcpy(out.data(), &mine, sizeof mine);
        parcels_[i].out = &out;
        statistics_.bytes += out.size();
    }
    const auto start = WallClock::now();
    transport_.swap(parcels_);
    statistics_.waited += seconds_since(start);
}

RankProgress RankExchange::meet(RankProgress mine, Environment& environment) {
    const Scheduler& scheduler = environment.scheduler;
    ++statistics_.meetings;
    mine.next = scheduler.next();
    carry(mine, true);
    const auto theirs = [&] {
        RankProgress progress;
        std::memcpy(static_cast<void*>(&progress), parcels_.front().in.data(), sizeof progress);
        return progress;
    };
    agreed_ = mine;
    const bool two = count() == 2;
    if (two) agreed_.join(theirs());
    for (std::size_t i = 0; i < peers_.size(); ++i) {
        peers_[i].links->clear(environment.pools);
        peers_[i].links->deliver(parcels_[i].in.data() + sizeof(RankProgress),
                                 parcels_[i].size - sizeof(RankProgress), environment.pools,
                                 environment.answer_routing);
    }
    // The messages delivered wake no client before the next cycle: if that cycle is run anyway, no second
    // round is needed.
    if (two && agreed_.next == scheduler.now() + 1) return agreed_;
    mine.next = scheduler.next();
    ++statistics_.second_rounds;
    if (two) {
        carry(mine, false);
        agreed_ = mine;
        agreed_.join(theirs());
        return agreed_;
    }
    const auto start = WallClock::now();
    agreed_ = transport_.agree(mine);
    statistics_.waited += seconds_since(start);
    return agreed_;
}

}  // namespace raycell
