#include "testbench/golden/traversal.hpp"

#include "testbench/golden/fields.hpp"
#include "testbench/golden/messages.hpp"

namespace raycell {
namespace {

constexpr const char* faces[] = {"left", "right", "top", "bottom", "front", "back"};
constexpr std::size_t decision_at = 4;  ///< behind the four counts

template <typename A, typename V>
void fields_of_voxel(A& a, V& voxel) {
    const Formats& f = a.formats();
    a.number("polygon", voxel.polygon, no_polygon - 1);
    a.number("object", voxel.object, 0xffffffffU);
    a.number("near_level", voxel.near_level, 65536);
    a.number("far_level", voxel.far_level, 65536);
    a.word("near", voxel.near, f.depth);
    a.word("far", voxel.far, f.depth);
    a.number("drop", voxel.drop, 2);
    fields_of_vector(a, {"nx", "ny", "nz"}, voxel.plane.n, f.unit);
    a.word("c", voxel.plane.c, f.offset);
    fields_of_vector(a, {"n0x", "n0y", "n0z"}, voxel.normal.base, f.normal);
    fields_of_vector(a, {"nux", "nuy", "nuz"}, voxel.normal.du, f.normal);
    fields_of_vector(a, {"nvx", "nvy", "nvz"}, voxel.normal.dv, f.normal);
    a.word("point_x", voxel.point.x, f.unit);
    a.word("point_y", voxel.point.y, f.unit);
    a.word("point_z", voxel.point.z, f.depth);
    a.mask("mask", voxel.mask);
    for (std::size_t i = 0; i < 4; ++i) {
        constexpr const char* names[] = {"u_from", "u_to", "v_from", "v_to"};
        a.number(names[i], voxel.window[i], window_steps);
    }
    a.number("pieces", voxel.pieces, 0xffffU);
    a.number("edges", voxel.edge_count, 0xffffU);
}

template <typename A, typename E>
void fields_of_edge(A& a, E& edge) {
    const Formats& f = a.formats();
    a.number("piece", edge.piece, 0xffffU);
    a.word("a", edge.a, f.unit);
    a.word("b", edge.b, f.unit);
    a.word("c", edge.c, f.edge_offset);
}

std::string place_text(const Words& words, const Ray& ray) {
    const Formats& f = words.formats();
    return words.word(f.unit, ray.position.x) + " " + words.word(f.unit, ray.position.y) + " " +
           words.word(f.depth, ray.position.z);
}

/// The face of the cube over which a ray is lost.
Face lost_over(const Ray& ray, const Visit& visit) {
    const bool depth = visit.event == Visit::Event::leaves_cube || ray.outside;
    return depth ? face_of_depth(ray) : face_of(visit.crossing.side);
}

/// What happens to a ray, and its fields.
std::string outcome_of(const Words& words, const TraversalSetting& setting, const Ray& ray,
                       const Visit& visit) {
    const Formats& f = words.formats();
    const Arithmetic& arithmetic = setting.context.arithmetic;
    const Need need = need_of(ray, visit, setting.store, setting.x, setting.y,
                              buffer_classes(setting.machine.networks), setting.context);
    if (need.lost) return std::string("lost ") + faces[lost_over(ray, visit)];
    Ray moved = ray;
    switch (visit.event) {
        case Visit::Event::hit:
            return "hit " + std::to_string(visit.hit.voxel) + " " +
                   std::to_string(setting.store.voxels[visit.hit.voxel].polygon) + " " +
                   words.word(f.distance, visit.hit.t);
        case Visit::Event::reaches_source:
            return "source";
        case Visit::Event::leaves_cube:
            start_outside(moved, visit.hit.t, arithmetic);
            return std::string("outside ") + faces[face_of_depth(ray)] + " " +
                   words.word(f.distance, visit.hit.t) + " " + place_text(words, moved);
        case Visit::Event::forward:
            break;
    }
    const std::string side = name_of(visit.crossing.side);
    if (need.leaves) return "border " + side;
    cross(moved, visit.crossing, arithmetic);
    return "side " + side + " " + words.word(f.distance, visit.crossing.t) + " " + place_text(words, moved) +
           " " + words.reach(moved.reach);
}

std::vector<std::string> decision_names(const std::string& decision) {
    std::vector<std::string> names = {"cycles", "runs", "tests", "edges", "decision"};
    const auto add = [&](const std::vector<std::string>& more) {
        names.insert(names.end(), more.begin(), more.end());
    };
    if (decision == "hit") add({"voxel", "polygon", "t"});
    if (decision == "side") add({"side", "t", "x", "y", "z", "reach"});
    if (decision == "border") add({"side"});
    if (decision == "outside") add({"face", "t", "x", "y", "z"});
    if (decision == "lost") add({"face"});
    return names;
}

/// Reads the lines behind the head of a file.
class Replay {
  public:
    Replay(const GoldenFile& file, const CellSetup& setup, std::size_t most, const TestObserver& observer)
        : file_(file),
          setup_(setup),
          context_(setup_.scene, setup_.picture),
          words_(context_.arithmetic),
          packing_(context_, setup_.machine),
          most_(most),
          observer_(observer) {}

    TraversalReplay run() {
        for (const GoldenFile::Line& line : file_.lines) {
            const std::vector<std::string>& tokens = line.tokens;
            if (tokens[0] == "voxel") {
                if (replay_.tests > 0) fail(line, "a voxel comes after a test");
                named(line, [&] {
                    read_voxel(words_, tokens, store_);
                    check(store_.voxels.back());
                });
            } else if (tokens.size() > 1 && tokens[1] == "test") {
                if (tested_) fail(line, "the test before has no decision");
                named(line, [&] { test(line); });
            } else if (tokens.size() > 1 && tokens[1] == "found") {
                if (!tested_) fail(line, "a decision without a test");
                compare(line);
            } else {
                fail(line, "expected voxel, CYCLE test or CYCLE found");
            }
        }
        if (tested_) fail(file_.lines.back(), "the last test has no decision");
        return std::move(replay_);
    }

  private:
    [[noreturn]] void fail(const GoldenFile::Line& line, const std::string& what) const {
        throw GoldenError(file_.name + ":" + std::to_string(line.number) + ": " + what);
    }
    template <typename F>
    void named(const GoldenFile::Line& line, F&& read) const {
        try {
            read();
        } catch (const GoldenError& error) {
            fail(line, error.what());
        }
    }

    /// Refuses what no cell can have stored.
    void check(const Voxel& voxel) const {
        const std::size_t objects = context_.objects.size();
        if (voxel.object >= objects)
            throw GoldenError("field 'object': expected one of the head's " + std::to_string(objects));
        if (voxel.far < voxel.near) throw GoldenError("field 'far': expected no less than 'near'");
        const auto& w = voxel.window;
        if (setup_.picture.hit == HitTest::mask && (w[1] <= w[0] || w[3] <= w[2]))
            throw GoldenError("window: expected u_from below u_to and v_from below v_to");
    }

    /// CYCLE test FRESH LEAVES_FRONT BITS MESSAGE
    void test(const GoldenFile::Line& line) {
        const std::vector<std::string>& tokens = line.tokens;
        FieldReader reader(words_, tokens, 0);
        reader.number("cycle", cycle_, std::uint64_t(1) << 48U);
        FieldReader flags(words_, tokens, 2);
        bool fresh = false;
        bool front = false;
        flags.number("fresh", fresh, 1);
        flags.number("leaves_front", front, 1);
        if (tokens.size() < 6 || tokens[5].find("ray") == std::string::npos)
            throw GoldenError("expected CYCLE test FRESH LEAVES_FRONT BITS, then a ray");
        const Message message =
            read_message(words_, {tokens.begin() + 5, tokens.end()}, line.remarks, {}, pools_);
        const std::string wrong = packing_.objection(message, tokens[4] == no_bits ? "" : tokens[4]);
        if (!wrong.empty()) throw GoldenError(wrong);
        ray_ = message.ray->ray;
        give_back(message, pools_);
        ray_.fresh = fresh;
        ray_.leaves_front = front;
        tested_ = true;
        ++replay_.tests;
    }

    /// CYCLE found CYCLES RUNS TESTS EDGES DECISION FIELDS
    void compare(const GoldenFile::Line& line) {
        tested_ = false;
        const TraversalSetting setting{store_, context_, setup_.machine, setup_.x, setup_.y};
        const Visit visit = visit_cell(store_, ray_, context_);
        if (observer_) observer_(setting, ray_, visit);
        const std::string decision = decision_of(words_, setting, ray_, visit);
        const std::uint64_t done = cycle_ + visit_cycles(visit, setup_.picture, setup_.machine.costs);
        const std::vector<std::string> is = tokens_of(std::to_string(done) + " found " + decision);
        if (is == line.tokens || replay_.failures.size() >= most_) return;
        std::string what = "expected another decision";
        const std::size_t at = 2 + decision_at;
        if (line.tokens[0] != is[0]) {
            what = "cycle " + is[0] + ", expected " + line.tokens[0];
        } else if (line.tokens.size() == is.size() && line.tokens[at] == is[at]) {
            std::vector<std::string> names = decision_names(is[at]);
            what =
                difference({is.begin() + 1, is.end()}, {line.tokens.begin() + 1, line.tokens.end()}, names);
        }
        replay_.failures.push_back("line " + std::to_string(line.number) + ": " + what +
                                   "; it decided: " + decision);
    }

    const GoldenFile& file_;
    const CellSetup& setup_;
    Context context_;
    Words words_;
    Packing packing_;
    MessagePools pools_;
    CellStore store_;
    Ray ray_;
    std::uint64_t cycle_ = 0;
    bool tested_ = false;  ///< `ray_` was read, its decision was not
    std::size_t most_;
    const TestObserver& observer_;
    TraversalReplay replay_;
};

}  // namespace

std::string voxel_lines(const Words& words, const CellStore& store) {
    std::string text;
    for (std::size_t i = 0; i < store.voxels.size(); ++i) {
        const Voxel& voxel = store.voxels[i];
        FieldWriter writer(words);
        fields_of_voxel(writer, voxel);
        for (std::uint32_t edge = 0; edge < voxel.edge_count; ++edge)
            fields_of_edge(writer, store.edges[voxel.first_edge + edge]);
        text += "voxel " + std::to_string(i) + writer.text + "\n";
    }
    return text;
}

void read_voxel(const Words& words, const std::vector<std::string>& tokens, CellStore& store) {
    FieldReader reader(words, tokens);
    std::size_t index = 0;
    reader.number("index", index, 0xffffffffU);
    if (index != store.voxels.size())
        throw GoldenError("expected voxel " + std::to_string(store.voxels.size()));
    Voxel voxel;
    fields_of_voxel(reader, voxel);
    voxel.base = words.exact() ? 0 : voxel.near;
    voxel.first_edge = std::uint32_t(store.edges.size());
    for (std::uint32_t i = 0; i < voxel.edge_count; ++i) {
        EdgeFunction edge;
        fields_of_edge(reader, edge);
        store.edges.push_back(edge);
    }
    reader.finish();
    put_in_order(store.index, std::uint32_t(store.voxels.size()), voxel.near, voxel.far);
    store.voxels.push_back(voxel);
}

std::string decision_of(const Words& words, const TraversalSetting& setting, const Ray& ray,
                        const Visit& visit) {
    const Comparisons& c = visit.comparisons;
    return std::to_string(visit_cycles(visit, setting.context.settings, setting.machine.costs)) + " " +
           std::to_string(c.runs) + " " + std::to_string(c.tests) + " " + std::to_string(c.edges) + " " +
           outcome_of(words, setting, ray, visit);
}

TraversalReplay replay_traversal(const GoldenFile& file, const CellSetup& setup, std::size_t most,
                                 const TestObserver& observer) {
    return Replay(file, setup, most, observer).run();
}

}  // namespace raycell
