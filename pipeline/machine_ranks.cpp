// A machine that several ranks simulate: what they agree upon in every cycle, and how their results become
// one.
#include <algorithm>

#include "pipeline/machine.hpp"

namespace raycell {

RankProgress Machine::progress() const {
    const Counters& c = environment_.meters.counters;
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

std::vector<std::string> Machine::joined_lines(std::vector<std::vector<RowLine>> sections) const {
    std::vector<std::string> texts;
    for (std::vector<RowLine>& lines : sections) {
        if (ranks_) {
            ByteWriter bytes;
            for (const RowLine& line : lines) {
                bytes.put(line.row);
                bytes.put(line.text);
            }
            lines.clear();
            for (const Bytes& theirs : ranks_->gather_for_all(bytes.take())) {
                for (ByteReader reader(theirs); !reader.at_end();) {
                    const int row = reader.get<int>();
                    lines.push_back({row, reader.get_text()});
                }
            }
            std::stable_sort(lines.begin(), lines.end(),
                             [](const RowLine& a, const RowLine& b) { return a.row < b.row; });
        }
        for (RowLine& line : lines) texts.push_back(std::move(line.text));
    }
    return texts;
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
    ByteWriter bytes;  // cells stand in the order of their rows
    for (const Cell& cell : array_.cells()) bytes.put(cell.schedule_hash());
    Fnv whole;
    RankReaders readers(*ranks_, ranks_->gather(bytes.take()));
    if (readers.empty()) return 0;  // rank 0 knows
    for (int y = 0; y < environment_.height(); ++y) {
        ByteReader& row = readers.of_row(y);
        for (int x = 0; x < environment_.width(); ++x) whole.add(row.get<std::uint64_t>());
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
    const std::vector<std::uint32_t>& hops = environment_.meters.pixel_hops;
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
    const std::vector<Pixel>& mine = picture_.pixels;
    std::vector<Abroad> abroad;
    ByteWriter bytes;
    for (int y = 0; y < environment_.height(); ++y) {
        const std::size_t first = std::size_t(y) * width;
        if (environment_.share.contains(y)) {
            std::vector<Pixel> row(&mine[first], &mine[first] + width);
            for (std::size_t x = 0; x < width; ++x) row[x].hops = hops[first + x];
            bytes.put_all(row);
            continue;
        }
        for (std::size_t i = first; i < first + width; ++i) {
            const Pixel& p = mine[i];
            if (hops[i] == 0 && p.postponed == 0 && p.polygon == no_polygon) continue;
            abroad.push_back({i, p.depth, p.normal, p.polygon, p.postponed, hops[i]});
        }
    }
    bytes.put_all(abroad);
    RankReaders readers(*ranks_, ranks_->gather(bytes.take()));
    if (readers.empty()) return {};
    Picture picture(picture_.width, picture_.height);
    for (int y = 0; y < environment_.height(); ++y) {
        const auto row = readers.of_row(y).get_all<Pixel>();
        std::copy(row.begin(), row.end(), picture.pixels.begin() + std::ptrdiff_t(y) * picture_.width);
    }
    for (ByteReader& reader : readers) {
        for (const Abroad& a : reader.get_all<Abroad>()) {
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

/// A buffer of a link whose source's half is another rank's: which place it is, by the band of its cell.
struct Machine::FarBuffer {
    int rank;  ///< that has the source's half
    std::uint32_t number;
    std::uint32_t index;
    int band;               ///< no_band: a place of the exterior's
    WaitGraph::Index node;  ///< counted from the first of the band
    static constexpr int no_band = -1;
};

/// Adds the buffers at this rank's ends of links whose places are in `map`.
void Machine::add_far_buffers(const WaitMap& map, int band, std::vector<FarBuffer>& far) const {
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

/// Places in the order in which one rank alone would have them, so that all numbers are the same; then each
/// rank says what its own wait for. A source's half of a link knows the far end's place by the link's number.
void Machine::put_waits_together(WaitMap& map) const {
    std::vector<FarBuffer> far;
    ByteWriter places;
    for (const Band& band : environment_.share.bands()) {
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
        const Band* mine = environment_.share.band_at(ranks_->first_row(band));
        if (!mine) {
            map.read(reader);
            continue;
        }
        add_places(*mine, map);
        WaitMap skipped;
        skipped.read(reader);
    }
    const WaitGraph::Index outside_start = next();  // rank 0's, behind all cells'
    starts.push_back(outside_start);
    add_outside_places(map);
    int rank = 0;
    for (ByteReader& reader : readers) {
        WaitMap skipped;  // of the other ranks nothing
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
    for (const Band& band : environment_.share.bands()) add_waits(band, map);
    add_outside_waits(map);
    ByteWriter waits;
    for (const Band& band : environment_.share.bands()) {
        const auto at = std::size_t(ranks_->band_of(band.first));
        map.write_waits(waits, starts[at], starts[at + 1]);
    }
    map.write_waits(waits, outside_start, has_outside() ? next() : outside_start);
    for (const Bytes& theirs : ranks_->gather_for_all(waits.take())) {
        for (ByteReader reader(theirs); !reader.at_end();) map.read_waits(reader);
    }
}

}  // namespace raycell
