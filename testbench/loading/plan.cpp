#include "testbench/loading/plan.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

#include "model/machine/message.hpp"
#include "model/machine/stall.hpp"

namespace raycell::loading {
namespace {

using Kind = LoadItem::Kind;

class Digest {
  public:
    Digest& operator<<(std::uint64_t value) {
        hash_ = mix_bits(hash_, value);
        return *this;
    }
    Digest& operator<<(int value) { return *this << std::uint64_t(std::uint32_t(value)); }
    Digest& operator<<(std::uint32_t value) { return *this << std::uint64_t(value); }
    Digest& operator<<(double value) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        return *this << bits;
    }
    Digest& operator<<(const dvec3& v) { return *this << v.x << v.y << v.z; }
    Digest& operator<<(const Plane& p) { return *this << p.n << p.c; }
    Digest& operator<<(const NormalField& n) { return *this << n.base << n.du << n.dv; }
    Digest& operator<<(const EdgeFunction& e) { return *this << e.a << e.b << e.c << e.piece; }
    template <typename List>
    Digest& list(const List& items, int count) {
        *this << count;
        for (int i = 0; i < count; ++i) *this << items[std::size_t(i)];
        return *this;
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0;
};

void add(Digest& d, const Polygon& p) {
    d << p.id << p.object << p.plane << p.drop << p.slack << p.normal;
    d.list(p.vertices, int(p.vertices.size()));
}

void add(Digest& d, const Surface& s) {
    d << s.polygon << s.object << s.plane << s.drop << s.normal << s.slack << s.last_row;
}

void add(Digest& d, const Trapeze& t, const CornerIntensities& intensities) {
    d.list(t.corners, t.corner_count).list(t.edges, t.edge_count);
    d << t.rows.first << t.rows.last << t.columns.first << t.columns.last;
    d.list(intensities, int(intensities.size()));
}

void add(Digest& d, const Span& s) {
    d << s.polygon << s.object << s.x << s.last << s.plane << s.drop << s.normal;
    d.list(s.edges, s.edge_count);
    d << s.z << s.dz << s.n << s.dn << s.slack;
    d << s.intensity << s.d_intensity;
}

/// Goes through the scene in loading order and adds up the work of each unit and link.
class Planner {
  public:
    Planner(const CellScene& scene, const PictureSettings& picture, const MachineSettings& machine)
        : scene_(scene),
          picture_(picture),
          machine_(machine),
          costs_(machine.costs),
          arithmetic_(picture.numbers, extent_of(scene.frame)),
          bits_(message_bits(picture, machine, arithmetic_.formats())) {
        Layout& layout = plan_.layout;
        layout.width = scene.frame.width;
        layout.height = scene.frame.height;
        layout.lanes = std::min(machine.feed_lanes, layout.height);
        plan_.units.resize(layout.units());
        plan_.links.resize(layout.links());
        plan_.lanes.resize(std::size_t(layout.lanes));
        plan_.rows.resize(std::size_t(layout.height));
        lanes_.resize(std::size_t(layout.lanes));
        // One place more per row: entries at `last + 1` may be past its end.
        const std::size_t cells = std::size_t(layout.width + 1) * std::size_t(layout.height);
        voxels_begin_.resize(cells);
        spans_end_.resize(cells);
        cycles_end_.resize(cells);
        row_cycles_.resize(std::size_t(layout.height));
        stores_.resize(std::size_t(layout.width) * std::size_t(layout.height));
        plan_.lines.resize(stores_.size());
    }

    LoadPlan run() {
        plan_.voxel_cycles = costs_.load_voxel(picture_.hit);
        plan_.loading_units = machine_.loading_units;
        broadcast(Kind::setup, 0, bits_.setup(SourceCounts(scene_.sources, 1)));
        const std::vector<Polygon>& polygons = scene_.polygons;
        for (std::size_t begin = 0; begin < polygons.size();) {
            std::size_t end = begin;
            while (end < polygons.size() && polygons[end].object == polygons[begin].object) ++end;
            load_object(begin, end);
            begin = end;
        }
        broadcast(Kind::end_of_scene, 0, bits_.end_of_scene);
        add_up_rows();
        return std::move(plan_);
    }

  private:
    /// State of a lane.
    struct Lane {
        std::uint64_t work = 1;    ///< cycles of geometry for its next message
        std::int64_t object = -1;  ///< whose features it has sent
        bool takes_part = false;   ///< in the object at hand
        std::uint64_t broadcasts = 0;
        std::uint64_t broadcast_cycles = 0;  ///< on links of rows
    };
    /// A polygon's part inside the cube, and all its trapezes with their corners' intensities.
    struct Pieces {
        Polygon polygon;
        std::vector<Trapeze> trapezes;
        std::vector<CornerIntensities> intensities;
    };

    std::uint64_t feed_cycles(int bits) const { return std::uint64_t(link_cycles(bits, machine_.feed_bits)); }
    std::uint64_t array_cycles(int bits) const {
        return std::uint64_t(link_cycles(bits, machine_.link_bits));
    }
    Need& unit(std::size_t index) { return plan_.units[index]; }
    Need& link(std::size_t index) { return plan_.links[index]; }
    Lane& lane_state(int lane) { return lanes_[std::size_t(lane)]; }
    LanePlan& lane_plan(int lane) { return plan_.lanes[std::size_t(lane)]; }

    /// Whether a lane must look into a polygon. The only lane has all rows and does not ask.
    bool wants(int lane, const Polygon& polygon) const {
        const Layout& layout = plan_.layout;
        return layout.lanes == 1 ||
               may_touch_rows(polygon, {layout.first_row(lane), layout.last_row(lane)}, arithmetic_);
    }

    /// Loads the polygons [begin, end) of one object into all lanes. A lane passes over an object that does
    /// not touch its rows at once, over polygons of other objects one by one.
    void load_object(std::size_t begin, std::size_t end) {
        for (int lane = 0; lane < plan_.layout.lanes; ++lane) {
            Lane& state = lane_state(lane);
            state.takes_part = false;
            for (std::size_t i = begin; i < end && !state.takes_part; ++i)
                state.takes_part = wants(lane, scene_.polygons[i]);
            if (!state.takes_part) state.work += costs_.geometry_skip;
        }
        for (std::size_t i = begin; i < end; ++i) {
            const std::optional<Pieces> pieces = pieces_of(scene_.polygons[i]);
            for (int lane = 0; lane < plan_.layout.lanes; ++lane) {
                Lane& state = lane_state(lane);
                if (!state.takes_part) continue;
                if (!wants(lane, scene_.polygons[i])) {
                    state.work += costs_.geometry_skip;
                } else if (!pieces) {
                    state.work += costs_.geometry_polygon;
                } else {
                    load(lane, *pieces);
                }
            }
        }
    }

    /// Nothing if the polygon lies outside the cube.
    std::optional<Pieces> pieces_of(Polygon polygon) {
        if (!clip_to_cube(polygon, scene_.frame.cube(), arithmetic_)) return std::nullopt;
        Pieces pieces{std::move(polygon), {}, {}};
        pieces.trapezes = precompute(pieces.polygon, arithmetic_, plan_.layout.width, plan_.layout.height);
        for (const Trapeze& trapeze : pieces.trapezes) {
            pieces.intensities.push_back(picture_.display == Display::gouraud
                                             ? shade_corners(trapeze, scene_, arithmetic_)
                                             : CornerIntensities{});
        }
        ++plan_.counts.polygons;
        plan_.counts.trapezes += pieces.trapezes.size();
        return pieces;
    }

    void put_out(int lane, const LoadItem& item, int bits) {
        Lane& state = lane_state(lane);
        lane_plan(lane).polygons.push_back(digest_of(item));
        lane_plan(lane).geometry_work.push_back(std::uint32_t(state.work));
        unit(plan_.layout.geometry(lane)).add(1, state.work);
        link(plan_.layout.polygons(lane)).add(1, feed_cycles(bits));
        state.work = 1;
    }

    void broadcast(Kind kind, std::uint32_t object, int bits) {
        for (int lane = 0; lane < plan_.layout.lanes; ++lane) broadcast(lane, kind, object, bits);
    }

    /// Sends a message to every unit and over every link of a lane.
    void broadcast(int lane, Kind kind, std::uint32_t object, int bits) {
        const Layout& layout = plan_.layout;
        LoadItem item;
        item.kind = kind;
        item.object = object;
        put_out(lane, item, bits);
        const std::uint64_t digest = digest_of(item);
        unit(layout.precomputation(lane)).add(1, 0);
        link(layout.trapezes(lane)).add(1, feed_cycles(bits));
        lane_plan(lane).trapezes.push_back(digest);
        for (int y = layout.first_row(lane); y <= layout.last_row(lane); ++y) {
            unit(layout.distributor(y)).add(1, costs_.distribution_pass);
            if (y < layout.last_row(lane)) link(layout.down(y)).add(1, feed_cycles(bits));
            link(layout.row(y)).add(1, array_cycles(bits));
            plan_.rows[std::size_t(y)].push_back(digest);
        }
        ++lane_state(lane).broadcasts;
        lane_state(lane).broadcast_cycles += array_cycles(bits);
    }

    void load(int lane, const Pieces& pieces) {
        const Layout& layout = plan_.layout;
        const Polygon& polygon = pieces.polygon;
        Lane& state = lane_state(lane);
        if (state.object != std::int64_t(polygon.object)) {
            state.object = polygon.object;
            broadcast(lane, Kind::features, polygon.object, bits_.features);
        }
        ++plan_.sent_polygons;
        LoadItem item;
        item.kind = Kind::polygon;
        item.polygon = polygon;
        state.work += costs_.geometry_polygon;
        const int bits = int(polygon.vertices.size()) * bits_.vertex + bits_.polygon;
        put_out(lane, item, bits);
        unit(layout.precomputation(lane)).add(1, 0);
        item.kind = Kind::trapeze;
        bool shared = false;
        for (std::size_t i = 0; i < pieces.trapezes.size(); ++i) {
            const Trapeze& trapeze = pieces.trapezes[i];
            if (trapeze.rows.last < layout.first_row(lane) || trapeze.rows.first > layout.last_row(lane))
                continue;
            if (!shared) share(lane, trapeze);
            shared = true;
            ++plan_.sent_trapezes;
            item.trapeze = trapeze;
            item.intensities = pieces.intensities[i];
            lane_plan(lane).trapezes.push_back(digest_of(item));
            unit(layout.precomputation(lane)).cycles += costs_.precomputation_trapeze;
            link(layout.trapezes(lane)).add(1, feed_cycles(bits_of(trapeze)));
            distribute(lane, item,
                       1 + costs_.geometry_polygon + feed_cycles(bits) + costs_.precomputation_trapeze);
        }
    }

    int bits_of(const Trapeze& trapeze) const { return bits_.trapeze + trapeze.edge_count * bits_.edge; }
    int bits_of(const Span& span) const {
        return bits_.span + std::min(span.edge_count, bits_.span_edges) * bits_.edge;
    }

    /// Passes what the trapezes of a polygon share down to the last row of the lane that needs it.
    void share(int lane, const Surface& surface) {
        LoadItem item;
        item.kind = Kind::surface;
        static_cast<Surface&>(item.trapeze) = surface;
        lane_plan(lane).trapezes.push_back(digest_of(item));
        const Layout& layout = plan_.layout;
        const std::uint64_t on_link = feed_cycles(bits_.surface);
        link(layout.trapezes(lane)).add(1, on_link);
        for (int y = layout.first_row(lane); y <= layout.last_row(lane); ++y) {
            if (y > layout.first_row(lane)) link(layout.down(y - 1)).add(1, on_link);
            unit(layout.distributor(y)).add(1, costs_.distribution_pass);
            if (surface.last_row <= y) break;
        }
    }

    /// Passes a trapeze from the lane's first row down to the last one that has a part of it. It leaves
    /// precomputation in cycle `way` at the earliest.
    void distribute(int lane, const LoadItem& item, std::uint64_t way) {
        const Layout& layout = plan_.layout;
        const Trapeze& trapeze = item.trapeze;
        const std::uint64_t on_link = feed_cycles(bits_of(trapeze));
        for (int y = layout.first_row(lane); y <= layout.last_row(lane); ++y) {
            if (y > layout.first_row(lane)) link(layout.down(y - 1)).add(1, on_link);
            const bool cuts = y >= trapeze.rows.first;
            const std::uint64_t work = cuts ? costs_.distribution_span : costs_.distribution_pass;
            unit(layout.distributor(y)).add(1, work);
            way += on_link + work;
            if (cuts) cut(item, y, way);
            if (cuts && !trapeze.reaches_below(y)) break;
        }
    }

    void cut(const LoadItem& from, int y, std::uint64_t way) {
        const bool gouraud = picture_.display == Display::gouraud;
        const auto span = cut_span(from.trapeze, y, scene_.frame.depth, picture_.hit, arithmetic_,
                                   gouraud ? &from.intensities : nullptr);
        if (!span) return;
        ++plan_.counts.spans;
        LoadItem item;
        item.kind = Kind::span;
        item.span = *span;
        plan_.rows[std::size_t(y)].push_back(digest_of(item));
        const std::uint64_t on_link = array_cycles(bits_of(*span));
        link(plan_.layout.row(y)).add(1, on_link);
        const std::size_t row = std::size_t(y) * std::size_t(plan_.layout.width + 1);
        ++voxels_begin_[row + std::size_t(span->x)];
        ++spans_end_[row + std::size_t(span->last) + 1];
        cycles_end_[row + std::size_t(span->last) + 1] += on_link;
        row_cycles_[std::size_t(y)] += on_link;
        for (Span part = *span;; advance(part, arithmetic_)) {
            const std::size_t cell = std::size_t(y) * std::size_t(plan_.layout.width) + std::size_t(part.x);
            plan_.lines[cell].push_back(
                store_voxel(stores_[cell], part, picture_, scene_.frame.level(), arithmetic_));
            if (part.x == part.last) break;
        }
        // It leaves a cell without waiting for its voxel there, so only the last one counts.
        way += std::uint64_t(span->last + 1) * on_link + std::uint64_t(span->x) * costs_.load_forward +
               std::uint64_t(span->last - span->x + 1) * costs_.load_advance + plan_.voxel_cycles;
        if (way > plan_.longest_way.cycles) {
            plan_.longest_way = {"the way of a span of polygon " + std::to_string(span->polygon) +
                                     " in row " + std::to_string(y),
                                 way};
        }
    }

    /// A span reaches every cell up to its last one and makes a voxel in those from its first one on.
    void add_up_rows() {
        const Layout& layout = plan_.layout;
        for (int y = 0; y < layout.height; ++y) {
            const Lane& lane = lane_state(layout.lane_of(y));
            const std::size_t row = std::size_t(y) * std::size_t(layout.width + 1);
            std::uint64_t reach = plan_.rows[std::size_t(y)].size() - lane.broadcasts;
            std::uint64_t making = 0;
            std::uint64_t on_links = row_cycles_[std::size_t(y)];
            for (int x = 0; x < layout.width; ++x) {
                const std::size_t at = row + std::size_t(x);
                if (x > 0) {
                    on_links -= cycles_end_[at];
                    link(layout.east(x - 1, y)).messages += reach - spans_end_[at] + lane.broadcasts;
                    link(layout.east(x - 1, y)).cycles += on_links + lane.broadcast_cycles;
                }
                reach -= spans_end_[at];
                making = making + voxels_begin_[at] - spans_end_[at];
                Need& cell = unit(layout.cell(x, y));
                cell.add(making, costs_.load_advance);
                cell.add(reach - making + lane.broadcasts, costs_.load_forward);
                cell.making = making * plan_.voxel_cycles;
            }
        }
    }

    const CellScene& scene_;
    const PictureSettings& picture_;
    const MachineSettings& machine_;
    const CostTable& costs_;
    Arithmetic arithmetic_;
    MessageBits bits_;
    LoadPlan plan_;
    std::vector<CellStore> stores_;  ///< of the cells, row-major, for their index tables
    std::vector<Lane> lanes_;
    std::vector<std::uint64_t> voxels_begin_;  ///< number of spans that begin in each cell
    std::vector<std::uint64_t> spans_end_;     ///< number of spans that end just before each cell
    std::vector<std::uint64_t> cycles_end_;    ///< their cycles on a link
    std::vector<std::uint64_t> row_cycles_;    ///< of all spans of a row on its first link
};

}  // namespace

std::uint64_t digest_of(const LoadItem& item) {
    Digest d;
    d << int(item.kind);
    switch (item.kind) {
        case Kind::features:
            d << item.object;
            break;
        case Kind::polygon:
            add(d, item.polygon);
            break;
        case Kind::surface:
            add(d, static_cast<const Surface&>(item.trapeze));
            break;
        case Kind::trapeze:
            add(d, item.trapeze, item.intensities);
            break;
        case Kind::span:
            add(d, item.span);
            break;
        case Kind::setup:
        case Kind::end_of_scene:
            break;
    }
    return d.value();
}

LoadPlan plan_loading(const CellScene& scene, const PictureSettings& picture,
                      const MachineSettings& machine) {
    return Planner(scene, picture, machine).run();
}

LoadPlan::Bound LoadPlan::busiest() const {
    Bound most;
    const auto larger = [&](std::uint64_t cycles) { return cycles > most.cycles; };
    for (std::size_t i = 0; i < units.size(); ++i) {
        if (larger(units[i].cycles)) most = {layout.unit_name(i), units[i].cycles};
        const std::uint64_t voxels = units[i].making / std::max<std::uint64_t>(voxel_cycles, 1);
        const std::uint64_t each = std::uint64_t(loading_units);  // the unit with the most
        const std::uint64_t cycles = (voxels + each - 1) / each * voxel_cycles;
        if (larger(cycles)) most = {"voxels of " + layout.unit_name(i), cycles};
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
        if (larger(links[i].cycles)) most = {layout.link_name(i), links[i].cycles};
    }
    return most;
}

LoadPlan::Bound LoadPlan::bound() const {
    const Bound most = busiest();
    return longest_way.cycles > most.cycles ? longest_way : most;
}

}  // namespace raycell::loading
