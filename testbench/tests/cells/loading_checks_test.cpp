// The checks of loading_tb: they pass on what the machine does and fail on faulty runs.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "elaboration.hpp"
#include "estimates.hpp"
#include "testbench/loading/checks.hpp"
#include "testbench/loading/random_scene.hpp"
#include "testbench/loading/tap.hpp"

namespace raycell::loading {
namespace {

PictureSettings picture_of(int width, int height) {
    PictureSettings picture;
    picture.width = width;
    picture.height = height;
    picture.stage = RunStage::load;
    return picture;
}

struct Event {
    bool sent;
    std::size_t link;
    const LoadItem* identity;
    LoadItem item;
    int cycles;
    Cycle now;
};

class Recorder : public LoadListener {
  public:
    void sent(std::size_t link, const LoadItem& item, int cycles, Cycle now) override {
        events.push_back({true, link, &item, item, cycles, now});
    }
    void popped(std::size_t link, const LoadItem& item, Cycle now) override {
        events.push_back({false, link, &item, item, 0, now});
    }
    std::vector<Event> events;
};

/// The recorded loading of a small machine, to be replayed to a watch as it was or altered.
struct Recording {
    explicit Recording(const MachineSettings& machine_settings = {}) : settings(machine_settings) {
        expect_first_elaboration();
        RandomPolygons random;
        random.count = 30;
        random.objects = 3;
        random.seed = 4;
        scene = random_scene(random, picture);
        plan = plan_loading(scene, picture, settings);
        Machine machine("machine", scene, picture, settings, nullptr);
        Recorder recorder;
        MachineTap tap(machine, plan.layout, recorder);
        result = machine.run();
        events = std::move(recorder.events);
    }
    LoadWatch watch(const std::vector<Event>& shown) const { return watch(shown, plan, settings); }
    /// A watch that has been shown these events and expects this. Events about the same item still refer to
    /// one item.
    static LoadWatch watch(const std::vector<Event>& shown, const LoadPlan& plan,
                           const MachineSettings& settings) {
        LoadWatch watch(plan, settings);
        std::map<const LoadItem*, LoadItem> items;
        for (const Event& event : shown) {
            LoadItem& item = items[event.identity];
            item = event.item;
            if (event.sent) {
                watch.sent(event.link, item, event.cycles, event.now);
            } else {
                watch.popped(event.link, item, event.now);
            }
        }
        watch.finish();
        return watch;
    }
    /// Index of the `count`-th event (from 0) with these properties.
    std::size_t find(bool sent, std::size_t link, LoadItem::Kind kind, int count = 0) const {
        for (std::size_t i = 0; i < events.size(); ++i) {
            const Event& e = events[i];
            if (e.sent == sent && e.link == link && e.item.kind == kind && count-- == 0) return i;
        }
        throw std::logic_error("the recording has no such event");
    }
    PictureSettings picture = picture_of(6, 5);
    MachineSettings settings;
    CellScene scene;
    LoadPlan plan;
    RunResult result;
    std::vector<Event> events;
};

MachineSettings feed(int lanes, int bits, int queue) {
    MachineSettings settings;
    settings.feed_lanes = lanes;
    settings.feed_bits = bits;
    settings.load_queue = queue;
    return settings;
}

std::uint64_t most_kept(const LoadWatch& watch) {
    std::uint64_t most = 0;
    for (const UnitUse& use : watch.units()) most = std::max(most, use.most_kept);
    return most;
}

/// Also expects as many spans kept at a time as the machine counted.
void expect_nothing_wrong(const Recording& recording) {
    LoadWatch watch = recording.watch(recording.events);
    watch.finish_at(recording.result.load_cycles);
    EXPECT_EQ(watch.order().count, 0u) << watch.order().first.front();
    EXPECT_EQ(watch.content().count, 0u) << watch.content().first.front();
    EXPECT_EQ(watch.conservation().count, 0u) << watch.conservation().first.front();
    EXPECT_EQ(watch.promptness().count, 0u) << watch.promptness().first.front();
    EXPECT_EQ(check_bound(recording.result.load_cycles, recording.plan.bound()).count, 0u);
    EXPECT_EQ(most_kept(watch), recording.result.counters.most_kept);
}

TEST(LoadWatch, FindsNothingWrongWithARunAsItWas) {
    const Recording recording;
    EXPECT_EQ(recording.plan.layout.lanes, 5) << "not more than rows";
    expect_nothing_wrong(recording);
}

TEST(LoadWatch, FindsNothingWrongWithOneLaneForAllRows) { expect_nothing_wrong(Recording(feed(1, 128, 0))); }

TEST(LoadWatch, FindsNothingWrongWithNarrowLanesOfTwoRowsAndMore) {
    expect_nothing_wrong(Recording(feed(2, 7, 0)));
}

TEST(LoadWatch, FindsNothingWrongWhereCellsKeepOnlyTheSpanAtWork) {
    const Recording recording(feed(2, 20, 1));
    expect_nothing_wrong(recording);
    EXPECT_EQ(most_kept(recording.watch(recording.events)), 1u);
}

TEST(LoadWatch, FindsNothingWrongWhereCellsKeepThreeSpans) {
    const Recording recording(feed(3, 128, 3));
    expect_nothing_wrong(recording);
    EXPECT_EQ(most_kept(recording.watch(recording.events)), 3u);
}

TEST(LoadWatch, NoticesACellThatKeepsMoreSpansThanItMay) {
    const Recording recording(feed(2, 128, 3));
    const MachineSettings fewer = feed(2, 128, 2);
    const Faults faults = Recording::watch(recording.events, recording.plan, fewer).promptness();
    EXPECT_GT(faults.count, 0u);
}

TEST(LoadWatch, NoticesASpanThatWaitsThoughTheCellHasAPlaceForIt) {
    const Recording recording(feed(2, 128, 3));
    const MachineSettings more = feed(2, 128, 4);
    const Faults faults = Recording::watch(recording.events, recording.plan, more).promptness();
    EXPECT_GT(faults.count, 0u);
}

TEST(LoadWatch, NoticesALoadingThatIsOverBeforeTheLastVoxelIsMade) {
    const Recording recording;
    LoadWatch watch = recording.watch(recording.events);
    watch.finish_at(recording.result.load_cycles - 1);
    ASSERT_EQ(watch.promptness().count, 1u);
    EXPECT_NE(watch.promptness().first.at(0).find("its last cell is loaded"), std::string::npos);
}

TEST(LoadWatch, NoticesAPolygonThatGoesDownAnotherLane) {
    const Recording recording;
    const Layout& layout = recording.plan.layout;
    std::vector<Event> events = recording.events;
    const std::size_t a = recording.find(true, layout.polygons(0), LoadItem::Kind::polygon, 0);
    for (const Event& event : recording.events) {
        if (!event.sent || event.link != layout.polygons(1) || event.item.kind != LoadItem::Kind::polygon ||
            event.item.polygon.id == events[a].item.polygon.id)
            continue;
        events[a].item = event.item;
        break;
    }
    const Faults faults = recording.watch(events).content();
    ASSERT_EQ(faults.count, 1u);
    EXPECT_NE(faults.first.at(0).find("geometry_0.out"), std::string::npos) << faults.first.at(0);
}

TEST(LoadWatch, NoticesALaneThatPassesOverAPolygonInOtherCyclesThanItShould) {
    MachineSettings dear = feed(5, 128, 0);
    const Recording recording(dear);
    dear.costs.geometry_skip += 5;
    const LoadPlan plan = plan_loading(recording.scene, recording.picture, dear);
    const Faults faults = Recording::watch(recording.events, plan, dear).promptness();
    ASSERT_GT(faults.count, 0u);
    EXPECT_NE(faults.first.at(0).find("link geometry_"), std::string::npos) << faults.first.at(0);
}

TEST(LoadWatch, NoticesWiresOfAnotherWidth) {
    const Recording recording(feed(2, 128, 0));
    const MachineSettings narrower = feed(2, 100, 0);
    const LoadPlan plan = plan_loading(recording.scene, recording.picture, narrower);
    const Faults faults = Recording::watch(recording.events, plan, narrower).content();
    ASSERT_GT(faults.count, 0u);
    EXPECT_NE(faults.first.at(0).find("cycles on the wires"), std::string::npos) << faults.first.at(0);
}

TEST(LoadWatch, NoticesTwoSpansOfARowThatChangePlaces) {
    const Recording recording;
    const std::size_t row = recording.plan.layout.row(2);
    std::vector<Event> events = recording.events;
    const std::size_t a = recording.find(true, row, LoadItem::Kind::span, 0);
    const std::size_t b = recording.find(true, row, LoadItem::Kind::span, 1);
    ASSERT_NE(digest_of(events[a].item), digest_of(events[b].item));
    std::swap(events[a].item, events[b].item);
    const LoadWatch watch = recording.watch(events);
    EXPECT_EQ(watch.content().count, 2u);
    EXPECT_NE(watch.content().first.at(0).find("distribution.row_2.east"), std::string::npos)
        << watch.content().first.at(0);
}

TEST(LoadWatch, NoticesAMessageThatComesOutOfABufferOutOfItsTurn) {
    Recording recording;
    std::vector<Event> events = recording.events;
    const std::size_t a =
        recording.find(false, recording.plan.layout.polygons(1), LoadItem::Kind::polygon, 4);
    const std::size_t b =
        recording.find(false, recording.plan.layout.polygons(1), LoadItem::Kind::polygon, 5);
    std::swap(events[a].identity, events[b].identity);
    std::swap(events[a].item, events[b].item);
    EXPECT_EQ(recording.watch(events).order().count, 2u);
}

TEST(LoadWatch, NoticesOneChangedBitOfATrapeze) {
    const Recording recording;
    std::vector<Event> events = recording.events;
    const std::size_t link = recording.plan.layout.trapezes(1);
    Trapeze& trapeze = events[recording.find(true, link, LoadItem::Kind::trapeze, 7)].item.trapeze;
    trapeze.edges[0].c = std::nextafter(trapeze.edges[0].c, 1e9);
    EXPECT_EQ(recording.watch(events).content().count, 1u);
}

TEST(LoadWatch, NoticesAMessageThatLeavesACycleLate) {
    const Recording recording;
    std::vector<Event> events = recording.events;
    // Nothing follows the last mark of the last row, so that nothing else becomes late.
    const Layout& layout = recording.plan.layout;
    const std::size_t link = layout.east(layout.width - 2, layout.height - 1);
    events[recording.find(true, link, LoadItem::Kind::end_of_scene)].now += 1;
    const Faults faults = recording.watch(events).promptness();
    EXPECT_GE(faults.count, 1u);
    EXPECT_NE(faults.first.at(0).find(layout.link_name(link)), std::string::npos) << faults.first.at(0);
}

TEST(LoadWatch, NoticesAMessageThatIsLostOnALink) {
    const Recording recording;
    std::vector<Event> events = recording.events;
    const Layout& layout = recording.plan.layout;
    const std::size_t link = layout.east(layout.width - 2, layout.height - 1);
    const std::size_t lost = recording.find(false, link, LoadItem::Kind::end_of_scene);
    events.erase(events.begin() + std::ptrdiff_t(lost));
    const LoadWatch watch = recording.watch(events);
    EXPECT_EQ(watch.conservation().count, 2u) << "the link, and the row";
    EXPECT_EQ(watch.order().count, 1u) << "a cell without an end-of-scene mark";
}

TEST(LoadWatch, NoticesASpanWithoutTheFeaturesOfItsObject) {
    const Recording recording;
    std::vector<Event> events = recording.events;
    const std::size_t row = recording.plan.layout.row(1);
    for (Event& event : events) {
        if (event.link == row && event.item.kind == LoadItem::Kind::features) event.item.object += 100;
    }
    EXPECT_GT(recording.watch(events).order().count, 0u);
}

TEST(LoadBound, FailsForARunThatIsFasterThanItsBusiestLink) {
    LoadPlan::Bound bound{"precomputation.out", 1000};
    EXPECT_EQ(check_bound(1000, bound).count, 0u);
    const Faults faults = check_bound(999, bound);
    ASSERT_EQ(faults.count, 1u);
    EXPECT_NE(faults.first[0].find("precomputation.out"), std::string::npos);
}

TEST(LoadBound, IsTheLargerOfACellsTwoKindsOfWorkNotTheirSum) {
    LoadPlan plan;
    plan.units.resize(plan.layout.units());
    plan.links.resize(plan.layout.links());
    Need& cell = plan.units[plan.layout.cell(0, 0)];
    plan.voxel_cycles = 10;
    cell.cycles = 70;
    cell.making = 60;
    EXPECT_EQ(plan.bound().cycles, 70u);
    EXPECT_EQ(plan.bound().of, "cell_0_0");
    cell.making = 80;
    EXPECT_EQ(plan.bound().cycles, 80u);
    EXPECT_EQ(plan.bound().of, "voxels of cell_0_0");
    plan.loading_units = 2;
    cell.making = 150;
    EXPECT_EQ(plan.bound().cycles, 80u) << "15 voxels: one unit makes 8 of them";
}

TEST(LoadLayout, GivesEachLaneItsRowsAndNoLinkBelowTheLast) {
    const Layout layout{2, 7, 3};
    const std::vector<int> lanes = {0, 0, 1, 1, 2, 2, 2};
    for (int y = 0; y < 7; ++y) {
        EXPECT_EQ(layout.lane_of(y), lanes[std::size_t(y)]) << y;
        EXPECT_EQ(layout.absent(layout.down(y)), y == 1 || y == 3 || y == 6) << y;
        EXPECT_FALSE(layout.absent(layout.row(y)));
    }
    EXPECT_EQ(layout.sink_of(layout.trapezes(1)), layout.distributor(2));
    EXPECT_EQ(layout.input_of(layout.distributor(4)), layout.trapezes(2));
    EXPECT_EQ(layout.input_of(layout.distributor(5)), layout.down(4));
    EXPECT_EQ(layout.link_name(layout.trapezes(2)), "precomputation_2.out");
    EXPECT_EQ((Layout{2, 7, 1}.link_name(1)), "precomputation.out");
    for (std::size_t link = 0; link < layout.links(); ++link) {
        if (!layout.absent(link)) {
            EXPECT_EQ(layout.input_of(layout.sink_of(link)), link) << layout.link_name(link);
        }
    }
}

/// The stores of a timed and an untimed loading. `cell()` gives the timed store with the most edges, to be
/// altered.
class Stores {
  public:
    explicit Stores(HitTest hit) {
        PictureSettings picture = picture_of(7, 4);
        picture.hit = hit;
        RandomPolygons random;
        random.count = 40;
        const CellScene scene = random_scene(random, picture);
        const Arithmetic arithmetic(picture.numbers, extent_of(scene.frame));
        untimed_ = timed_ = load_array(scene, picture, arithmetic);
        for (std::size_t i = 0; i < timed_.size(); ++i) {
            if (timed_[i].edges.size() > timed_[fullest_].edges.size()) fullest_ = i;
        }
        if (timed_[fullest_].voxels.empty()) throw std::logic_error("nothing to alter");
    }
    CellStore& cell() { return timed_[fullest_]; }
    Faults compare() const {
        std::vector<const CellStore*> cells;
        for (const CellStore& store : timed_) cells.push_back(&store);
        return compare_stores(cells, untimed_, 7);
    }

  private:
    std::vector<CellStore> timed_;
    std::vector<CellStore> untimed_;
    std::size_t fullest_ = 0;
};

TEST(StoreCheck, FailsWhereOneBitOfOneVoxelDiffersAndSaysWhere) {
    const auto next = [](double value) { return std::nextafter(value, 1e300); };
    const std::vector<std::pair<HitTest, std::function<void(CellStore&)>>> alterations = {
        {HitTest::edge, [&](CellStore& c) { c.voxels[0].near = next(c.voxels[0].near); }},
        {HitTest::edge, [&](CellStore& c) { c.voxels[0].plane.c = next(c.voxels[0].plane.c); }},
        {HitTest::edge, [&](CellStore& c) { c.voxels[0].normal.dv.y = next(c.voxels[0].normal.dv.y); }},
        {HitTest::edge, [&](CellStore& c) { c.voxels[0].far_level += 1; }},
        {HitTest::edge, [&](CellStore& c) { c.voxels[0].polygon += 1; }},
        {HitTest::edge, [&](CellStore& c) { c.edges.at(0).b = next(c.edges.at(0).b); }},
        {HitTest::edge, [&](CellStore& c) { c.voxels.pop_back(); }},
        {HitTest::edge, [&](CellStore& c) { c.overflowed = 1; }},
        {HitTest::mask, [&](CellStore& c) { c.voxels[0].mask ^= 1; }},
        {HitTest::depth, [&](CellStore& c) { c.voxels[0].point.z = next(c.voxels[0].point.z); }}};
    for (const auto& [hit, alter] : alterations) {
        Stores stores(hit);
        EXPECT_EQ(stores.compare().count, 0u);
        alter(stores.cell());
        const Faults faults = stores.compare();
        ASSERT_EQ(faults.count, 1u);
        EXPECT_EQ(faults.first[0].rfind("cell (", 0), 0u) << faults.first[0];
    }
}

/// A triangle with the horizontal side on top, so that it is one trapeze, in the middle of cell (x, y).
Polygon triangle(std::uint32_t id, std::uint32_t object, double x, double y) {
    return make_polygon(id, object,
                        {{x + 0.25, y + 0.25, 4}, {x + 0.75, y + 0.25, 4}, {x + 0.25, y + 0.75, 4}});
}

CellScene scene_of(const PictureSettings& picture, const std::vector<Polygon>& polygons) {
    CellScene scene;
    scene.frame.width = picture.width;
    scene.frame.height = picture.height;
    scene.frame.depth = 8;
    scene.frame.depth_levels = picture.depth_levels;
    for (const Polygon& polygon : polygons)
        scene.objects.resize(std::max<std::size_t>(scene.objects.size(), polygon.object + 1));
    scene.polygons = polygons;
    return scene;
}

/// A lane looks once at an object none of whose polygons touches its rows, else at each of its polygons.
TEST(LoadPlan, ALanePassesOverWhatDoesNotTouchItsRows) {
    const PictureSettings picture = picture_of(1, 2);
    MachineSettings settings = feed(2, 128, 0);
    settings.costs = estimated_machine().costs;
    settings.costs.geometry_polygon = 40;
    settings.costs.geometry_skip = 3;
    const CellScene scene =
        scene_of(picture, {triangle(0, 0, 0, 0), triangle(1, 0, 0, 0), triangle(2, 1, 0, 1),
                           triangle(3, 1, 0, 0), triangle(4, 2, 0, 1), triangle(5, 2, 9, 1)});
    const LoadPlan plan = plan_loading(scene, picture, settings);
    const std::vector<std::uint32_t> upper = {1,                 // sources and viewer
                                              1,     41, 41,     // object 0
                                              1 + 3, 41,         // object 1: polygon 3
                                              1 + 3};            // object 2, the mark
    const std::vector<std::uint32_t> lower = {1,     1 + 3, 41,  // past object 0; object 1: polygon 2
                                              1 + 3, 41,         // past polygon 3; object 2: polygon 4
                                              1 + 40};           // polygon 5 lies outside the cube
    EXPECT_EQ(plan.lanes.at(0).geometry_work, upper);
    EXPECT_EQ(plan.lanes.at(1).geometry_work, lower);
    EXPECT_EQ(plan.counts.polygons, 5u);
    EXPECT_EQ(plan.counts.trapezes, 5u);
    EXPECT_EQ(plan.sent_polygons, 5u) << "none of these needs two lanes";
    const LoadPlan single = plan_loading(scene, picture, [&] {
        MachineSettings one = settings;
        one.feed_lanes = 1;
        return one;
    }());
    const std::vector<std::uint32_t> all = {1, 1, 41, 41, 1, 41, 41, 1, 41, 1 + 40};
    EXPECT_EQ(single.lanes.at(0).geometry_work, all) << "the only lane passes over nothing";
}

/// Cycles computed by hand from the cost table and the bits of the messages: one triangle in one cell.
TEST(LoadCycles, OneTriangleInOneCellTakesTheCyclesOfItsMessages) {
    expect_first_elaboration();
    const PictureSettings picture = picture_of(1, 1);
    MachineSettings settings = estimated_machine();
    settings.feed_bits = 50;
    settings.link_bits = 20;
    const CellScene scene = scene_of(picture, {triangle(0, 0, 0, 0)});
    const LoadPlan plan = plan_loading(scene, picture, settings);
    ASSERT_EQ(plan.counts.trapezes, 1u);
    Machine machine("machine", scene, picture, settings, nullptr);
    const RunResult result = machine.run();
    const MessageBits& bits = machine.environment().bits;
    const auto feed_link = [](int message_bits_) { return Cycle((message_bits_ + 49) / 50); };
    const auto row_link = [](int message_bits_) { return Cycle((message_bits_ + 19) / 20); };
    // Sources and viewer leave geometry in cycle 2, the features one cycle of work later when the wires are
    // free, and the polygon after 41 cycles of work.
    Cycle t = 2;
    t = std::max(t + 2, t + feed_link(bits.setup(0)));
    t = std::max(t + 1 + 41, t + feed_link(bits.features));
    t += feed_link(bits.polygon + 3 * bits.vertex);
    // What its trapezes share leaves a cycle later; the trapeze is ready when the wires are free again.
    t += 1 + std::max(Cycle(1 + 20), feed_link(bits.surface));
    t += feed_link(bits.longest_trapeze()) + 8 + row_link(bits.longest_span());
    // The cell looks at the span for a cycle, makes its voxel and puts it in order. The mark passes
    // meanwhile.
    EXPECT_EQ(result.load_cycles, t + 1 + 12 + 1);
    // The span's way is all of that but what waits for the messages before it.
    EXPECT_EQ(plan.longest_way.cycles, 41 + feed_link(bits.polygon + 3 * bits.vertex) + 20 +
                                           feed_link(bits.longest_trapeze()) + 8 +
                                           row_link(bits.longest_span()) + 1 + 12);
}

/// Two spans for the first cell and one for the second, all long before the first voxel is made.
TEST(LoadCycles, ASpanWaitsForAPlaceInTheCellAndThoseBehindItWaitToo) {
    expect_first_elaboration();
    const PictureSettings picture = picture_of(2, 1);
    MachineSettings settings = estimated_machine();
    constexpr Cycle making = 1000;
    settings.costs.load_edge = making;
    const CellScene scene =
        scene_of(picture, {triangle(0, 0, 0, 0), triangle(1, 0, 0, 0), triangle(2, 0, 1, 0)});
    std::vector<std::unique_ptr<Machine>> machines;
    for (const int queue : {0, 1, 2}) {
        settings.load_queue = queue;
        const std::string name = "queue_" + std::to_string(queue);
        machines.push_back(std::make_unique<Machine>(name.c_str(), scene, picture, settings, nullptr));
    }
    std::vector<Cycle> cycles;
    for (const auto& machine : machines) cycles.push_back(machine->run().load_cycles);
    EXPECT_EQ(cycles[2], cycles[0]) << "two places are enough";
    // The first voxel is done `making` cycles before the end of the others. Then the second span's voxel
    // begins, and the third leaves its row a cycle later: two links, a cycle in each cell, and its own voxel.
    const int bits = machines[0]->environment().bits.longest_span();
    EXPECT_EQ(cycles[1], cycles[0] - making + 1 + 2 * (Cycle(bits + 19) / 20 + 1) + making);
}

}  // namespace
}  // namespace raycell::loading
