// The checks of loading_tb: they pass on what the machine does and fail on faulty runs.
#include <cmath>
#include <map>

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
    Recording() {
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
    /// A watch that has been shown these events. Events about the same item still refer to one item.
    LoadWatch watch(const std::vector<Event>& shown) const {
        LoadWatch watch(plan, settings, Machine::stage_link_depth);
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

TEST(LoadWatch, FindsNothingWrongWithARunAsItWas) {
    const Recording recording;
    const LoadWatch watch = recording.watch(recording.events);
    EXPECT_EQ(watch.order().count, 0u) << watch.order().first.front();
    EXPECT_EQ(watch.content().count, 0u) << watch.content().first.front();
    EXPECT_EQ(watch.conservation().count, 0u) << watch.conservation().first.front();
    EXPECT_EQ(watch.promptness().count, 0u) << watch.promptness().first.front();
    EXPECT_EQ(check_bound(recording.result.load_cycles, recording.plan.bound()).count, 0u);
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
    const std::size_t a = recording.find(false, Layout::polygons, LoadItem::Kind::polygon, 4);
    const std::size_t b = recording.find(false, Layout::polygons, LoadItem::Kind::polygon, 5);
    std::swap(events[a].identity, events[b].identity);
    std::swap(events[a].item, events[b].item);
    EXPECT_EQ(recording.watch(events).order().count, 2u);
}

TEST(LoadWatch, NoticesOneChangedBitOfATrapeze) {
    const Recording recording;
    std::vector<Event> events = recording.events;
    Trapeze& trapeze =
        events[recording.find(true, Layout::trapezes, LoadItem::Kind::trapeze, 7)].item.trapeze;
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

/// Cycles computed by hand from the cost table and the bits of the messages: one triangle in one cell.
TEST(LoadCycles, OneTriangleInOneCellTakesTheCyclesOfItsMessages) {
    expect_first_elaboration();
    const PictureSettings picture = picture_of(1, 1);
    MachineSettings settings = estimated_machine();
    CellScene scene;
    scene.frame.depth = 8;
    scene.frame.depth_levels = picture.depth_levels;
    scene.objects.resize(1);
    // The horizontal side is on top, so that the triangle is one trapeze.
    scene.polygons.push_back(make_polygon(0, 0, {{0.25, 0.25, 4}, {0.75, 0.25, 4}, {0.25, 0.75, 4}}));
    const LoadPlan plan = plan_loading(scene, picture, settings);
    ASSERT_EQ(plan.counts.trapezes, 1u);
    Machine machine("machine", scene, picture, settings, nullptr);
    const RunResult result = machine.run();
    const MessageBits& bits = machine.environment().bits;
    const auto link = [](int message_bits_) { return Cycle((message_bits_ + 19) / 20); };
    // Sources and viewer leave geometry in cycle 2, the features one cycle of work later when the wires are
    // free, and the polygon after 41 cycles of work.
    Cycle t = 2;
    t = std::max(t + 2, t + link(bits.setup(0)));
    t = std::max(t + 1 + 41, t + link(bits.features));
    t += link(bits.polygon + 3 * bits.vertex);
    // What its trapezes share leaves a cycle later; the trapeze is ready when the wires are free again.
    t += 1 + std::max(Cycle(1 + 20), link(bits.surface));
    t += link(bits.longest_trapeze()) + 8 + link(bits.longest_span()) + 12;
    // The mark has been waiting behind the span for a place in the buffer: one cycle until the distributor
    // sees it, one on the wires, one in the cell.
    EXPECT_EQ(result.load_cycles, t + 3);
    EXPECT_LE(plan.longest_way.cycles, t);
}

}  // namespace
}  // namespace raycell::loading
