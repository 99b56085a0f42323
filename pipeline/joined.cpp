#include "pipeline/joined.hpp"

#include <algorithm>

namespace raycell {

std::vector<std::string> Joined::lines(std::vector<std::vector<RowLine>> sections) const {
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

/// Levels are differences of counters, and other ranks may count a ray's end: a level of one rank is a number
/// modulo 2^64, and only the sum over all ranks is a level of the machine.
void Joined::join(Activity& activity) const {
    if (!ranks_) return;
    ByteWriter bytes;
    bytes.put_all(activity.buckets);
    for (Activity::Bucket& bucket : activity.buckets) bucket = Activity::Bucket();
    for (const Bytes& theirs : ranks_->gather_for_all(bytes.take())) {
        const auto buckets = ByteReader(theirs).get_all<Activity::Bucket>();
        for (std::size_t i = 0; i < buckets.size(); ++i) activity.buckets.at(i) += buckets[i];
    }
}

std::uint64_t Joined::schedule_hash() const {
    if (!ranks_) return parts_.array.schedule_hash();
    ByteWriter bytes;  // cells() is in the order of the rows
    for (const Cell& cell : parts_.array.cells()) bytes.put(cell.schedule_hash());
    Fnv whole;
    RankReaders readers(*ranks_, ranks_->gather(bytes.take()));
    if (readers.empty()) return 0;  // only rank 0 has it
    for (int y = 0; y < parts_.environment.height(); ++y) {
        ByteReader& row = readers.of_row(y);
        for (int x = 0; x < parts_.environment.width(); ++x) whole.add(row.get<std::uint64_t>());
    }
    return whole.value();
}

void Joined::join(Ledger& ledger) const {
    if (!ranks_) return;
    ByteWriter bytes;
    ledger.write(bytes);
    ledger = Ledger();
    for (const Bytes& theirs : ranks_->gather(bytes.take())) {
        ByteReader reader(theirs);
        ledger.add(reader);
    }
}

/// A rank has the final answers of the pixels of its own rows. Hops, postponements and first hits are
/// recorded by the rank in which they happen, for pixels of any rank; a first hit is recorded by one rank
/// only.
Picture Joined::picture() const {
    const std::vector<std::uint32_t>& hops = parts_.environment.meters.pixel_hops;
    if (!ranks_) {
        Picture picture = parts_.picture;
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
    const auto width = std::size_t(parts_.picture.width);
    const int block_height = parts_.environment.context.scene.frame.block_height;
    const std::vector<Pixel>& mine = parts_.picture.pixels;
    std::vector<Abroad> abroad;
    ByteWriter bytes;
    for (int y = 0; y < parts_.picture.height; ++y) {
        const std::size_t first = std::size_t(y) * width;
        if (parts_.environment.share.contains(y / block_height)) {
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
    Picture picture(parts_.picture.width, parts_.picture.height);
    for (int y = 0; y < parts_.picture.height; ++y) {
        const auto row = readers.of_row(y / block_height).get_all<Pixel>();
        std::copy(row.begin(), row.end(), picture.pixels.begin() + std::ptrdiff_t(y) * parts_.picture.width);
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

}  // namespace raycell
