#include "testbench/cell/script.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "model/loading/loading.hpp"
#include "model/loading/trapeze.hpp"

namespace raycell {
namespace {

Frame script_frame() {
    Frame frame;
    frame.width = frame.height = 3;
    frame.depth = frame.depth_levels = 10;
    frame.viewer_at_infinity = true;
    return frame;
}

}  // namespace

const Arithmetic& script_arithmetic() {
    static const Arithmetic arithmetic(NumberSettings(), extent_of(script_frame()));
    return arithmetic;
}

Script::Script(std::string name, std::string says) {
    scenario_.name = std::move(name);
    scenario_.says = std::move(says);
    CellSetup& setup = scenario_.setup;
    setup.machine.costs = CostTable(CostBasis::estimate);  // scenarios write their cycles out
    setup.machine.buffer_depth = setup.machine.loading_units = setup.machine.traversal_units = 1;
    setup.picture.width = setup.picture.height = 3;
    setup.picture.depth_levels = 10;
    setup.picture.exterior = ExteriorMode::none;
    setup.picture.viewer = ViewerMode::infinity;
    setup.picture.normal_offset = 0;
    setup.scene.frame = script_frame();
    setup.x = setup.y = 1;
    setup.linked.fill(true);
}

Script& Script::add(GoldenEvent::What what, Cycle cycle, Side side, int index, int cycles,
                    const std::string& text) {
    scenario_.events.push_back({what, cycle, int(side), index, cycles, tokens_of(text), 0});
    return *this;
}

Script& Script::add(GoldenEvent::What what, Cycle cycle, Side side, int index, int cycles, Message message) {
    const Words words(script_arithmetic(), scenario_.setup.picture);
    add(what, cycle, side, index, cycles, text_of(words, message));
    scenario_.events.back().remarks = tokens_of(remarks_of(message));
    return *this;
}

Script& Script::in(Cycle cycle, Side from, int index, int cycles, const Ray& ray) {
    RayPacket packet;
    packet.ray = ray;
    return add(GoldenEvent::What::in, cycle, from, index, cycles, Message(&packet));
}

Script& Script::in(Cycle cycle, Side from, int index, int cycles, const Answer& answer) {
    Answer copy = answer;
    return add(GoldenEvent::What::in, cycle, from, index, cycles, Message(&copy));
}

Script& Script::in(Cycle cycle, Side from, int cycles, const LoadItem& item) {
    LoadItem copy = item;
    return add(GoldenEvent::What::in, cycle, from, 0, cycles, Message(&copy));
}

Script& Script::free(Cycle cycle, Side towards, int index) {
    return add(GoldenEvent::What::free, cycle, towards, index, 0, "");
}

Script& Script::trace(Cycle first) { return add(GoldenEvent::What::phase, first, Side::east, 0, 0, "trace"); }

Script& Script::drain(Cycle cycle, bool on) {
    return add(GoldenEvent::What::drain, cycle, Side::east, 0, 0, on ? "1" : "0");
}

Script& Script::take(Cycle cycle, Side from, int index) {
    return add(GoldenEvent::What::take, cycle, from, index, 0, "");
}

Script& Script::out(Cycle cycle, Side towards, int index, int cycles, const Ray& ray) {
    RayPacket packet;
    packet.ray = ray;
    return add(GoldenEvent::What::out, cycle, towards, index, cycles, Message(&packet));
}

Script& Script::out(Cycle cycle, Side towards, int index, int cycles, const Answer& answer) {
    Answer copy = answer;
    return add(GoldenEvent::What::out, cycle, towards, index, cycles, Message(&copy));
}

Script& Script::out(Cycle cycle, Side towards, int cycles, const LoadItem& item) {
    LoadItem copy = item;
    return add(GoldenEvent::What::out, cycle, towards, 0, cycles, Message(&copy));
}

Script& Script::pixel(Cycle cycle, const dvec3& colour) {
    const Words words(script_arithmetic());
    std::string text;
    for (int channel = 0; channel < 3; ++channel)
        text += " " + words.word(words.formats().intensity, colour[channel]);
    return add(GoldenEvent::What::pixel, cycle, Side::east, 0, 0, text);
}

Scenario Script::until(Cycle last) {
    scenario_.last = last;
    std::stable_sort(scenario_.events.begin(), scenario_.events.end(),
                     [](const GoldenEvent& a, const GoldenEvent& b) { return a.cycle < b.cycle; });
    // As a recorder does, which reads the pixel after the run.
    std::stable_partition(scenario_.events.begin(), scenario_.events.end(),
                          [](const GoldenEvent& event) { return event.what != GoldenEvent::What::pixel; });
    return scenario_;
}

LoadItem load_item(LoadItem::Kind kind, std::uint32_t object) {
    LoadItem item;
    item.kind = kind;
    item.object = object;
    return item;
}

LoadItem span_of(const CellSetup& setup, std::uint32_t polygon, const dvec3& corner, const dvec3& u,
                 const dvec3& v, int x, int y) {
    const Arithmetic& arithmetic = script_arithmetic();
    LoadItem item = load_item(LoadItem::Kind::span);
    Polygon whole = make_polygon(polygon, 0, {corner, corner + u, corner + u + v, corner + v});
    if (!clip_to_cube(whole, setup.scene.frame.cube(), arithmetic))
        throw std::logic_error("a rectangle of a scenario must lie in the cube");
    const std::vector<Trapeze> trapezes =
        precompute(whole, arithmetic, setup.picture.width, setup.picture.height);
    const auto span = trapezes.size() == 1
                          ? cut_span(trapezes[0], y, setup.scene.frame.depth, setup.picture.hit, arithmetic)
                          : std::nullopt;
    if (!span)
        throw std::logic_error("a rectangle of a scenario must be one trapeze that meets the cell's row");
    item.span = *span;
    while (item.span.x < x) advance(item.span, arithmetic);
    return item;
}

}  // namespace raycell
