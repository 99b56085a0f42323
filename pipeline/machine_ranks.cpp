// A machine that several ranks simulate: what they agree upon in every cycle, and how their results become
// one.
#include <algorithm>

#include "pipeline/machine.hpp"

namespace raycell {

RankProgress Machine::progress() const {
    const Counters& c = environment_.counters;
    RankProgress mine;
    mine.last_progress = c.last_progress;
    mine.rays_destroyed = c.rays_destroyed;
    mine.done = environment_.phase == Phase::load ? c.cells_loaded : c.pixels_done;
    mine.hops = c.load_hops + c.rays.ray_hops + c.rays.return_hops;
    mine.interrupted = interrupt_ && *interrupt_;
    return mine;
}

Cycle Machine::meet(void* self, Cycle) {
    auto& machine = *static_cast<Machine*>(self);
    return machine.ranks_->meet(machine.progress(), machine.environment_).next;
}

std::uint64_t Machine::sum(std::uint64_t mine) const {
    return joined(mine, [](std::uint64_t& a, std::uint64_t b) { a += b; });
}

std::vector<std::string> Machine::joined_lines(std::vector<std::vector<std::string>> sections) const {
    std::vector<std::string> lines;
    const auto append = [&](const std::vector<std::string>& more) {
        lines.insert(lines.end(), more.begin(), more.end());
    };
    if (!ranks_) {
        for (const auto& section : sections) append(section);
        return lines;
    }
    for (const auto& section : sections) {
        ByteWriter bytes;
        for (const std::string& line : section) bytes.put(line);
        for (const Bytes& theirs : ranks_->gather_for_all(bytes.take())) {
            for (ByteReader reader(theirs); !reader.at_end();) lines.push_back(reader.get_text());
        }
    }
    return lines;
}

/// Levels are differences of counters, each of which another rank may have counted: single ranks' are numbers
/// modulo 2^64, their sum is the machine's.
void Machine::join_activity(Activity& activity) const {
    if (!ranks_) return;
    ByteWriter bytes;
    bytes.put_all(activity.buckets);
    for (Activity::Bucket& bucket : activity.buckets) bucket = Activity::Bucket();
    for (const Bytes& theirs : ranks_->gather_for_all(bytes.take())) {
        const auto buckets = ByteReader(theirs).get_all<Activity::Bucket>();
        for (std::size_t i = 0; i < buckets.size(); ++i) activity.buckets.at(i) += buckets[i];
    }
}

std::uint64_t Machine::joined_schedule_hash() const {
    if (!ranks_) return array_.schedule_hash();
    std::vector<std::uint64_t> hashes;
    for (const Cell& cell : array_.cells()) hashes.push_back(cell.schedule_hash());
    ByteWriter bytes;
    bytes.put_all(hashes);
    ScheduleHash whole;
    for (const Bytes& theirs : ranks_->gather(bytes.take())) {
        for (const std::uint64_t hash : ByteReader(theirs).get_all<std::uint64_t>()) whole.add(hash);
    }
    return whole.value();
}

void Machine::join_ledger(Ledger& ledger) const {
    if (!ranks_) return;
    ByteWriter bytes;
    ledger.write(bytes);
    ledger = Ledger();
    for (const Bytes& theirs : ranks_->gather(bytes.take())) {
        ByteReader reader(theirs);
        ledger.add(reader);
    }
}

/// Of its own rows a rank has what came home. Hops are counted, and first hits recorded, wherever they
/// happen: by any rank for any pixel, a first hit by one alone.
Picture Machine::whole_picture() const {
    const std::vector<std::uint32_t>& hops = environment_.pixel_hops;
    if (!ranks_) {
        Picture picture = picture_;
        for (std::size_t i = 0; i < hops.size(); ++i) picture.pixels[i].hops = hops[i];
        return picture;
    }
    struct Abroad {
        std::uint64_t pixel;
        double depth;
        dvec3 normal;
        std::uint32_t polygon;
        std::uint32_t postponed;
        std::uint32_t hops;
    };
    const auto width = std::size_t(environment_.width());
    const std::size_t first = std::size_t(environment_.share.first) * width;
    const std::size_t end = std::size_t(environment_.share.end) * width;
    const std::vector<Pixel>& mine = picture_.pixels;
    std::vector<Abroad> abroad;
    for (std::size_t i = 0; i < mine.size(); ++i) {
        const Pixel& p = mine[i];
        if ((i >= first && i < end) || (hops[i] == 0 && p.postponed == 0 && p.polygon == no_polygon))
            continue;
        abroad.push_back({i, p.depth, p.normal, p.polygon, p.postponed, hops[i]});
    }
    ByteWriter bytes;
    bytes.put(std::uint64_t(first));
    std::vector<Pixel> home(mine.begin() + std::ptrdiff_t(first), mine.begin() + std::ptrdiff_t(end));
    for (std::size_t i = first; i < end; ++i) home[i - first].hops = hops[i];
    bytes.put_all(home);
    bytes.put_all(abroad);
    const std::vector<Bytes> all = ranks_->gather(bytes.take());
    Picture picture = all.empty() ? Picture() : Picture(picture_.width, picture_.height);
    std::vector<std::vector<Abroad>> others;
    for (const Bytes& theirs : all) {
        ByteReader reader(theirs);
        const auto from = reader.get<std::uint64_t>();
        const auto rows = reader.get_all<Pixel>();
        std::copy(rows.begin(), rows.end(), picture.pixels.begin() + std::ptrdiff_t(from));
        others.push_back(reader.get_all<Abroad>());
    }
    for (const auto& list : others) {
        for (const Abroad& a : list) {
            Pixel& pixel = picture.pixels.at(a.pixel);
            pixel.hops += a.hops;
            pixel.postponed += a.postponed;
            if (a.polygon == no_polygon) continue;
            pixel.depth = a.depth;
            pixel.normal = a.normal;
            pixel.polygon = a.polygon;
        }
    }
    return picture;
}

/// Places in the order in which one rank alone would have them, so that all numbers are the same; then each
/// rank says what its own wait for. A source's half of a link knows the far end's place by the link's number.
void Machine::put_waits_together(WaitMap& map) const {
    using Kind = WaitGraph::Kind;
    struct FarBuffer {
        int rank;  ///< that has the source's half
        std::uint32_t number;
        std::uint32_t index;
        WaitGraph::Index node;
        bool exterior;  ///< a place of the exterior's, not of the cells'
    };
    WaitMap cells;
    WaitMap exterior;
    for (const Cell& cell : array_.cells()) cell.add_places(cells);
    if (exterior_) exterior_->add_places(exterior);
    std::vector<FarBuffer> far;
    for (int rank = 0; rank < ranks_->count(); ++rank) {
        const SplitLinks* split = ranks_->links_to(rank);
        for (std::uint32_t number = 0; split && number < split->halves(); ++number) {
            if (split->has_source(number)) continue;
            const Link* link = &split->half(number);
            for (std::uint32_t index = 0; index < std::uint32_t(link->classes()); ++index) {
                if (const auto node = cells.find(link, Kind::buffer, index))
                    far.push_back({rank, number, index, *node, false});
                if (const auto node = exterior.find(link, Kind::buffer, index))
                    far.push_back({rank, number, index, *node, true});
            }
        }
    }
    ByteWriter bytes;
    bytes.put_all(far);
    cells.write(bytes);
    exterior.write(bytes);
    const std::vector<Bytes> all = ranks_->gather_for_all(bytes.take());

    const auto next = [&] { return WaitGraph::Index(map.graph().nodes().size()); };
    WaitGraph::Index own = 0;
    WaitGraph::Index own_end = 0;
    std::vector<WaitGraph::Index> starts;
    std::vector<ByteReader> readers;
    std::vector<std::vector<FarBuffer>> buffers;
    for (std::size_t rank = 0; rank < all.size(); ++rank) {
        readers.emplace_back(all[rank]);
        buffers.push_back(readers.back().get_all<FarBuffer>());
        starts.push_back(next());
        const bool me = int(rank) == ranks_->rank();
        if (me) own = next();
        if (me) {
            for (const Cell& cell : array_.cells()) cell.add_places(map);
            WaitMap skipped;
            skipped.read(readers.back());
            own_end = next();
        } else {
            map.read(readers.back());
        }
    }
    const WaitGraph::Index exterior_start = next();  // rank 0's, behind all cells'
    if (exterior_) {
        exterior_->add_places(map);
    } else {
        map.read(readers.front());
    }
    for (std::size_t rank = 0; rank < all.size(); ++rank) {
        for (const FarBuffer& buffer : buffers[rank]) {
            if (buffer.rank != ranks_->rank()) continue;
            const Link* half = &ranks_->links_to(int(rank))->half(buffer.number);
            map.name(half, Kind::buffer, buffer.index,
                     (buffer.exterior ? exterior_start : starts[rank]) + buffer.node);
        }
    }
    for (const Cell& cell : array_.cells()) cell.add_waits(map);
    if (exterior_) exterior_->add_waits(map);
    ByteWriter waits;
    map.write_waits(waits, own, own_end);
    map.write_waits(waits, exterior_start, exterior_ ? next() : exterior_start);
    for (const Bytes& theirs : ranks_->gather_for_all(waits.take())) {
        for (ByteReader reader(theirs); !reader.at_end();) map.read_waits(reader);
    }
}

}  // namespace raycell
