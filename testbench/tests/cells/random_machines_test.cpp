// At least 1000 random machines: each ends with a true verdict and loses no message, and a completed run has
// the untimed picture, bit for bit. Machines that must end by cells/deadlock/deadlock.md do end.
#include "../truth/hand_made.hpp"
#include "elaboration.hpp"
#include "knot_check.hpp"

namespace raycell {
namespace {

constexpr int cases = 24;
constexpr int machines_per_case = 50;

/// Mirrors, glass and matt rectangles anywhere in the cube and a little beyond it, with up to two sources.
CellScene random_scene(property::Random& random, int width, int height) {
    CellScene scene = hand_made::cube(width, height, random.uniform(1, 8));
    scene.frame.viewer_at_infinity = random.chance(0.3);
    scene.frame.eye = {random.uniform(-2, width + 2), random.uniform(-2, height + 2), -random.uniform(1, 9)};
    const dvec3 size(width, height, scene.frame.depth);
    const auto anywhere = [&] {
        const double x = random.uniform(-0.2, 1.2), y = random.uniform(-0.2, 1.2), z = random.uniform(0, 1);
        return size * dvec3(x, y, z);
    };
    for (int i = random.whole(0, 2); i > 0; --i) {
        Source source{anywhere(), dvec3(0.7)};
        source.kind = SourceKind(random.whole(0, source_kinds - 1));
        source.axis = hand_made::random_direction(random.engine());
        source.falloff = random.uniform(0, 5);
        source.edge_u = random.uniform(0.1, 3) * hand_made::random_direction(random.engine());
        source.edge_v = glm::cross(source.axis, source.edge_u) + 0.3 * source.edge_u;
        if (is_area(source.kind) && source.kind != SourceKind::sphere)
            source.axis = -glm::normalize(glm::cross(source.edge_u, source.edge_v));
        source.radius = random.uniform(0.1, 2);
        scene.sources.push_back(source);
    }
    const auto wall = [&](const Material& material, const dvec3& corner, const dvec3& u, const dvec3& v) {
        hand_made::add_rectangle(scene, hand_made::add_object(scene, material), corner, u, v);
    };
    const auto material = [&] {
        if (random.chance(0.5)) return hand_made::mirror(random.uniform(0.5, 1));
        if (random.chance(0.4)) return hand_made::glass(random.uniform(0.4, 1), random.uniform(0.8, 1.5));
        return hand_made::matt(0.8);
    };
    if (random.chance(0.6)) {  // facing mirrors: trees come back to the same cells
        const double lean = random.uniform(-0.3, 0.3) * width;
        const dvec3 across(0, size.y, 0);
        wall(hand_made::mirror(0.95), {0.02, 0, 0}, across, {lean + 0.3, 0, size.z});
        wall(hand_made::mirror(0.95), {width - 0.02, 0, 0}, across, {lean - 0.3, 0, size.z});
        wall(material(), {0, 0, 0.9 * size.z}, {size.x, 0, -0.5 * size.z}, across);
    }
    for (int i = random.whole(1, 4); i > 0; --i) {
        std::mt19937_64& engine = random.engine();
        wall(material(), anywhere(), hand_made::random_direction(engine) * random.uniform(1, 6),
             hand_made::random_direction(engine) * random.uniform(1, 6));
    }
    for (const Polygon& polygon : scene.polygons) {
        for (const dvec3& p : polygon.vertices) {
            for (int axis = 0; axis < 3; ++axis) {
                if (p[axis] < 0) scene.beyond[std::size_t(2 * axis)] = true;
                if (p[axis] > size[axis]) scene.beyond[std::size_t(2 * axis + 1)] = true;
            }
        }
    }
    return scene;
}

struct Drawn {
    PictureSettings settings;
    MachineSettings machine;
    std::unique_ptr<PlacedScene> placed;
    int least = 1;  ///< the bound of cells/deadlock/deadlock.md on M
    std::string text;
};

void draw_picture(Drawn& drawn, std::uint64_t seed, property::Random& random) {
    PictureSettings& s = drawn.settings;
    const int shape = random.whole(0, 9);
    s.width = shape == 0 ? 1 : random.whole(2, 7);
    s.height = shape == 1 || shape == 2 ? 1 : random.whole(2, 6);
    s.depth_levels = random.whole(1, 64);
    s.hit = HitTest(random.whole(0, 4));
    s.shadows = Shadows(random.whole(0, 2));
    s.exterior = ExteriorMode(random.whole(0, 1));
    s.max_depth = random.whole(0, 5);
    s.source_samples = random.chance(0.2) ? random.whole(1, 32) : random.whole(1, 4);
    s.min_weight = random.chance(0.3) ? 1.0 / 256 : 0;
    s.numbers.arithmetic = random.chance(0.5) ? Numbers::exact : Numbers::fixed;
    s.numbers.word_bits = random.whole(12, 24);
    property::Random blocks(seed + 5000000);  // of its own, so that the other draws stay what they were
    if (blocks.chance(0.4)) {
        s.pixels_wide = s.width * blocks.whole(1, 3);
        s.pixels_high = s.height * blocks.whole(1, 3);
        drawn.machine.own_rays = blocks.whole(1, 5);
    }
    property::Random samples(seed + 6000000);
    if (samples.chance(0.4)) {
        s.samples = samples.whole(2, 9);
        s.filter = samples.chance(0.3) ? PixelFilter::tent : PixelFilter::box;
        if (samples.chance(0.5)) s.sample_until = samples.uniform(0, 0.3);
        drawn.machine.own_rays = samples.whole(1, 6);
    }
    if (random.chance(0.25)) {
        const char* const own[] = {"cornell", "facing_mirrors", "still_life"};
        const char* const name = own[random.whole(0, 2)];
        drawn.placed = place_own_scene(name, s);
        drawn.text = std::string(name) + " ";
        return;
    }
    drawn.placed = std::make_unique<PlacedScene>();
    drawn.placed->scene = random_scene(random, s.width, s.height);
    drawn.placed->scene.frame.depth_levels = s.depth_levels;
    drawn.placed->scene.frame.block_width = s.block_width();
    drawn.placed->scene.frame.block_height = s.block_height();
    drawn.placed->truth = std::make_unique<TruthRenderer>(
        drawn.placed->scene, TruthSettings{s.max_depth, s.min_weight, false, TruthOf::scene, nullptr, 4});
    drawn.placed->exterior = std::make_unique<ClassicalExterior>(drawn.placed->scene, *drawn.placed->truth);
    drawn.text = "hand-made ";
}

void draw_machine(Drawn& drawn, property::Random& random) {
    MachineSettings& m = drawn.machine;
    m.buffer_depth = random.chance(0.6) ? 1 : random.whole(2, 4);
    m.networks = Networks(random.whole(0, 3));
    m.slots = random.chance(0.3) ? Slots::free : random.chance(0.5) ? Slots::reserved : Slots::nested;
    m.recovery = random.chance(0.7) ? Recovery::postpone : Recovery::none;
    m.ray_store = random.chance(0.4)    ? random.whole(1, drawn.least)
                  : random.chance(0.15) ? 10000
                                        : random.whole(drawn.least, drawn.least + 6);
    m.link_bits = random.chance(0.3) ? random.whole(1, 16) : random.whole(17, 300);
    m.exterior_processors = random.whole(1, 4);
    m.exterior_latency = random.whole(1, 60);
    m.seed = std::uint64_t(random.whole(1, 1000));
    for (const auto& [name, member] : CostTable::entries()) {
        if (random.chance(0.2)) m.costs.*member = std::uint32_t(random.whole(1, 40));
    }
    m.costs.backoff = std::uint32_t(random.whole(1, 16));  // short, since each livelock must be waited for
    if (random.chance(0.3)) m.stall = random.uniform(0.01, 0.6);
    m.feed_lanes = random.whole(1, 6);
    m.feed_bits = random.whole(1, 300);
    m.load_queue = random.chance(0.5) ? 0 : random.whole(1, 4);
    if (random.chance(0.3)) m.start_within = std::uint32_t(random.whole(1, 3000));
    // Further settings that only affect time belong here.
}

Drawn draw(std::uint64_t seed) {
    property::Random random(seed);
    Drawn drawn;
    draw_picture(drawn, seed, random);
    drawn.least = std::max(1, waiting_generations(Context(drawn.placed->scene, drawn.settings)));
    draw_machine(drawn, random);
    const PictureSettings& s = drawn.settings;
    const MachineSettings& m = drawn.machine;
    const char* const networks[] = {"shared", "split", "quadrant", "half"};
    const char* const slots[] = {"reserved, ", "free, ", "nested, "};
    drawn.text += std::to_string(s.width) + "x" + std::to_string(s.height) + ", " +
                  std::to_string(s.block()) + " pixels a cell, " + std::to_string(s.samples) + " samples" +
                  (s.sample_until < 0 ? "" : " at most") + ", " + std::to_string(m.own_rays) +
                  " own rays, M " + std::to_string(m.ray_store) + " (bound " + std::to_string(drawn.least) +
                  "), buffers " + std::to_string(m.buffer_depth) + ", " + networks[int(m.networks)] + ", " +
                  slots[int(m.slots)] + (m.recovery == Recovery::none ? "none" : "postpone") + ", links " +
                  std::to_string(m.link_bits) + ", shadows " + std::to_string(int(s.shadows)) + ", samples " +
                  std::to_string(s.source_samples) + ", stall " + std::to_string(m.stall) + ", exterior " +
                  std::to_string(int(s.exterior)) + ", generations " + std::to_string(s.max_depth);
    return drawn;
}

/// Whether pure forwarding can't form a ring; in a single row or column no ray turns.
bool acyclic(const Drawn& drawn) {
    const bool line = drawn.settings.width == 1 || drawn.settings.height == 1;
    const Networks n = drawn.machine.networks;
    return n == Networks::half || n == Networks::quadrant || (n == Networks::split && line);
}

/// Whether the theorems of cells/deadlock/deadlock.md say that the run ends.
bool must_end(const Drawn& drawn) {
    const MachineSettings& m = drawn.machine;
    const bool room_for_all = m.ray_store >= 10000;  // more than the rays that ever wait in these arrays
    const bool by_generation =
        m.recovery == Recovery::postpone && m.slots != Slots::free && m.ray_store >= drawn.least;
    return acyclic(drawn) && (room_for_all || by_generation);
}

/// Every value that a movement would change, independent of the scheduler.
std::vector<std::uint64_t> standing(Machine& machine) {
    const Counters& c = machine.environment().meters.counters;
    std::vector<std::uint64_t> all{c.rays_sent,    c.rays_answered,     c.rays_silent,   c.rays_destroyed,
                                   c.answers_sent, c.answers_delivered, c.rays.ray_hops, c.rays.return_hops,
                                   c.pixels_done,  c.traversal_cycles,  c.shading_cycles};
    for (const Link& link : machine.array().links()) {
        for (int index = 0; index < link.classes(); ++index) {
            all.push_back(std::uint64_t(link.occupancy(index)));
        }
    }
    for (const Cell& cell : machine.array().cells()) {
        all.push_back(std::uint64_t(cell.ray_store().used()));
    }
    return all;
}

/// Steps each cell in three cycles far in the future, when every transfer, test and back-off is over, and
/// expects no change.
void expect_nothing_can_move(Machine& machine) {
    Scheduler& scheduler = machine.environment().scheduler;
    const Cycle stopped = scheduler.now();
    const auto before = standing(machine);
    for (int turn = 1; turn <= 3; ++turn) {
        scheduler.set_now(stopped + (Cycle(1) << 40) + Cycle(turn));
        for (Cell& cell : machine.array().cells()) cell.step(scheduler.now());
    }
    EXPECT_EQ(standing(machine), before) << "a deadlock in which something can move";
    scheduler.set_now(stopped);
}

/// Expects at least one knot, and an independent search to accept each.
void expect_knots(const WaitGraph& graph) {
    std::vector<knot_check::Node> nodes;
    for (const WaitGraph::Node& n : graph.nodes()) {
        nodes.push_back({n.moves, n.all, {n.waits_for.begin(), n.waits_for.end()}});
    }
    EXPECT_TRUE(graph.deadlocked());
    for (const auto& knot : graph.knots()) {
        EXPECT_EQ(knot_check::objection(nodes, {knot.begin(), knot.end()}), "");
    }
}

void expect_conserved(const Environment& environment, bool completed) {
    const Counters& c = environment.meters.counters;
    const std::uint64_t open = c.rays_sent - c.rays_answered - c.rays_silent - c.rays_destroyed;
    const std::uint64_t there = environment.pools.rays.in_use();
    EXPECT_GE(open, there);
    // The exterior's processors may hold answers that can't leave.
    EXPECT_LE(open, there + std::uint64_t(completed ? 0 : environment.machine.exterior_processors));
    EXPECT_EQ(c.answers_sent - c.answers_delivered, environment.pools.answers.in_use());
    EXPECT_EQ(c.loads_sent, c.loads_delivered);
    if (!completed) return;
    EXPECT_EQ(there, 0u);
    EXPECT_EQ(environment.pools.answers.in_use(), 0u);
}

void expect_true_verdict(const Drawn& drawn, Machine& machine, const RunResult& result,
                         const Picture& golden) {
    const MachineSettings& m = drawn.machine;
    const std::uint64_t pixels = golden.pixels.size();
    expect_conserved(machine.environment(), result.verdict == Verdict::completed);
    switch (result.verdict) {
        case Verdict::completed:
            EXPECT_EQ(result.counters.pixels_done, pixels);
            EXPECT_EQ(image_hash(result.picture), image_hash(golden));
            EXPECT_LE(result.ray_store_peak, m.ray_store);
            return;
        case Verdict::deadlock:
            EXPECT_FALSE(acyclic(drawn) && m.recovery == Recovery::postpone)
                << "something can always move where no buffer waits for a slot";
            EXPECT_FALSE(result.report.empty());
            expect_knots(result.waits);
            expect_nothing_can_move(machine);
            break;
        case Verdict::livelock:
            EXPECT_EQ(m.recovery, Recovery::postpone);
            EXPECT_FALSE(result.waits.deadlocked());
            EXPECT_GT(result.counters.rays_destroyed, 0u);
            EXPECT_FALSE(result.report.empty());
            break;
        case Verdict::cycle_limit:
        case Verdict::capacity:
        case Verdict::interrupted:
            ADD_FAILURE() << "nothing limits or interrupts it here";
    }
    // In the precast phase no pixel has started yet; in the trace phase at least one is missing.
    EXPECT_LT(result.counters.pixels_done, pixels);
    EXPECT_FALSE(must_end(drawn)) << name_of(result.verdict);
}

class TimedRandomMachines : public ::testing::TestWithParam<int> {};

TEST_P(TimedRandomMachines, EndWithATrueVerdictAndWhereCompletedTheUntimedPicture) {
    expect_first_elaboration();
    const auto seeds =
        property::seeds(1000000 + std::uint64_t(GetParam()) * machines_per_case, machines_per_case);
    std::vector<Drawn> drawn;
    std::vector<Machine*> machines;  // never destroyed: SystemC destroys ports in quadratic time
    for (const std::uint64_t seed : seeds) {
        drawn.push_back(draw(seed));
        const Drawn& d = drawn.back();
        machines.push_back(new Machine(("machine_" + std::to_string(seed)).c_str(), d.placed->scene,
                                       d.settings, d.machine, d.placed->exterior.get()));
    }
    std::map<std::string, int> verdicts;
    std::vector<Picture> goldens;
    for (const Drawn& d : drawn) {
        goldens.push_back(UntimedMachine(d.placed->scene, d.settings, d.placed->exterior.get()).render());
    }
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        SCOPED_TRACE(drawn[i].text + "; " + property::rerun(seeds[i]));
        // sc_start returns when no client has anything to do, so the machines run one after the other.
        const RunResult result = machines[i]->run();
        ++verdicts[name_of(result.verdict)];
        expect_true_verdict(drawn[i], *machines[i], result, goldens[i]);
    }
    std::string line = "seeds from " + std::to_string(seeds.front()) + ":";
    for (const auto& [name, count] : verdicts) line += " " + std::to_string(count) + " " + name;
    std::cout << line << "\n";
    RecordProperty("verdicts", line);
}

INSTANTIATE_TEST_SUITE_P(Case, TimedRandomMachines, ::testing::Range(0, cases));

}  // namespace
}  // namespace raycell
