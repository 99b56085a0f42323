#include "pipeline/machine_waits.hpp"

#include <algorithm>

namespace raycell {

WaitGraph MachineWaits::graph() const {
    WaitMap map;
    if (ranks_) {
        put_together(map);
    } else {
        const Band& all = parts_.environment.share.bands().front();
        add_places(all, map);
        add_outside_places(map);
        add_waits(all, map);
        add_outside_waits(map);
    }
    // Messages still on the wires and operations still going on have `since` in the future.
    for (WaitGraph::Index i = 0; i < map.graph().nodes().size(); ++i)
        map.graph()[i].since = std::min(map.graph()[i].since, parts_.scheduler.now());
    map.graph().analyse();
    return std::move(map.graph());
}

void MachineWaits::add_places(const Band& band, WaitMap& map) const {
    for (int y = band.first; y < band.end; ++y) {
        if (parts_.environment.phase == Phase::load) {
            if (const FeedLane* lane = parts_.lane_at(y)) {
                lane->geometry.add_places(map);
                lane->precomputation.add_places(map, lane->polygons);
            }
            parts_.distribution.row(y).add_places(map);
        }
        for (int x = 0; x < parts_.environment.width(); ++x)
            raycell::add_places(parts_.array.cell(x, y), map);
    }
}

void MachineWaits::add_waits(const Band& band, WaitMap& map) const {
    for (int y = band.first; y < band.end; ++y) {
        if (parts_.environment.phase == Phase::load) {
            if (const FeedLane* lane = parts_.lane_at(y)) {
                lane->geometry.add_waits(map);
                lane->precomputation.add_waits(map, lane->polygons);
            }
            parts_.distribution.row(y).add_waits(map);
        }
        for (int x = 0; x < parts_.environment.width(); ++x) raycell::add_waits(parts_.array.cell(x, y), map);
    }
}

/// Whether this rank has the places outside the array: the exterior.
bool MachineWaits::has_outside() const { return parts_.environment.phase != Phase::load && parts_.exterior; }

void MachineWaits::add_outside_places(WaitMap& map) const {
    if (has_outside()) parts_.exterior->add_places(map);
}

void MachineWaits::add_outside_waits(WaitMap& map) const {
    if (has_outside()) parts_.exterior->add_waits(map);
}

/// A buffer of a half link whose source is another rank's, and its node, counted within a band.
struct MachineWaits::FarBuffer {
    int rank;  ///< the rank that has the source's half
    std::uint32_t number;
    std::uint32_t index;
    int band;               ///< of its cell; no_band: a place of the exterior
    WaitGraph::Index node;  ///< counted from the band's first node
    static constexpr int no_band = -1;
};

/// Appends to `far` the buffers in `map` of half links whose source is another rank's.
void MachineWaits::add_far_buffers(const WaitMap& map, int band, std::vector<FarBuffer>& far) const {
    for (int rank = 0; rank < ranks_->count(); ++rank) {
        const SplitLinks* split = ranks_->links_to(rank);
        for (std::uint32_t number = 0; split && number < split->halves(); ++number) {
            if (split->has_source(number)) continue;
            const Link* link = &split->half(number);
            for (std::uint32_t index = 0; index < std::uint32_t(link->classes()); ++index) {
                if (const auto node = map.find(link, WaitGraph::Kind::buffer, index))
                    far.push_back({rank, number, index, band, *node});
            }
        }
    }
}

/// Adds the places of all ranks in the order of a machine without ranks, so that all numbers are equal on all
/// ranks. The half link's number tells a source the node of its far end. Returns the first node of each band,
/// then that of the places outside the array.
std::vector<WaitGraph::Index> MachineWaits::put_places_together(WaitMap& map) const {
    std::vector<FarBuffer> far;
    ByteWriter places;
    for (const Band& band : parts_.environment.share.bands()) {
        WaitMap rows;
        add_places(band, rows);
        add_far_buffers(rows, ranks_->band_of(band.first), far);
        rows.write(places);
    }
    WaitMap outside;
    add_outside_places(outside);
    add_far_buffers(outside, FarBuffer::no_band, far);
    outside.write(places);
    places.put_all(far);
    RankReaders readers(*ranks_, ranks_->gather_for_all(places.take()));

    const auto next = [&] { return WaitGraph::Index(map.graph().nodes().size()); };
    std::vector<WaitGraph::Index> starts;
    for (int band = 0; band < ranks_->bands(); ++band) {
        starts.push_back(next());
        ByteReader& reader = readers.of_row(ranks_->first_row(band));
        const Band* mine = parts_.environment.share.band_at(ranks_->first_row(band));
        if (!mine) {
            map.read(reader);
            continue;
        }
        add_places(*mine, map);
        WaitMap skipped;
        skipped.read(reader);
    }
    const WaitGraph::Index outside_start = next();  // rank 0 has them; they follow all cells
    starts.push_back(outside_start);
    add_outside_places(map);
    int rank = 0;
    for (ByteReader& reader : readers) {
        WaitMap skipped;  // the other ranks have no places outside
        (rank == 0 && !has_outside() ? map : skipped).read(reader);
        for (const FarBuffer& buffer : reader.get_all<FarBuffer>()) {
            if (buffer.rank != ranks_->rank()) continue;
            const Link* half = &ranks_->links_to(rank)->half(buffer.number);
            const bool beyond = buffer.band == FarBuffer::no_band;
            const WaitGraph::Index start = beyond ? outside_start : starts[std::size_t(buffer.band)];
            map.name(half, WaitGraph::Kind::buffer, buffer.index, start + buffer.node);
        }
        ++rank;
    }
    return starts;
}

/// Adds all places, then what they wait for: each rank contributes its own places.
void MachineWaits::put_together(WaitMap& map) const {
    const std::vector<WaitGraph::Index> starts = put_places_together(map);
    for (const Band& band : parts_.environment.share.bands()) add_waits(band, map);
    add_outside_waits(map);
    ByteWriter waits;
    for (const Band& band : parts_.environment.share.bands()) {
        const auto at = std::size_t(ranks_->band_of(band.first));
        map.write_waits(waits, starts[at], starts[at + 1]);
    }
    map.write_waits(waits, starts.back(),
                    has_outside() ? WaitGraph::Index(map.graph().nodes().size()) : starts.back());
    for (const Bytes& theirs : ranks_->gather_for_all(waits.take())) {
        for (ByteReader reader(theirs); !reader.at_end();) map.read_waits(reader);
    }
}

}  // namespace raycell
