#include "testbench/loading/tap.hpp"

#include <stdexcept>

namespace raycell::loading {

void MachineTap::LinkTap::sent(const Link&, int, const Message& message, int cycles, Cycle now) {
    listener_.sent(index_, *message.load, cycles, now);
}

void MachineTap::LinkTap::popped(const Link&, int, const Message& message, Cycle now) {
    listener_.popped(index_, *message.load, now);
}

void MachineTap::listen(Link& link, std::size_t index) {
    if (taps_.size() == taps_.capacity()) throw std::logic_error("more loading links than the layout has");
    link.set_observer(&taps_.emplace_back(listener_, index));
    links_.push_back(&link);
}

MachineTap::MachineTap(Machine& machine, const Layout& layout, LoadListener& listener) : listener_(listener) {
    taps_.reserve(layout.links());  // links keep pointers to their taps
    if (machine.lanes().size() != std::size_t(layout.lanes))
        throw std::logic_error("other lanes than the layout's");
    for (int lane = 0; lane < layout.lanes; ++lane) {
        listen(machine.lanes()[std::size_t(lane)]->polygons, layout.polygons(lane));
        listen(machine.lanes()[std::size_t(lane)]->trapezes, layout.trapezes(lane));
    }
    std::size_t downs = 0;  // the machine has no links between lanes
    for (int y = 0; y < layout.height; ++y) {
        listen(*machine.row_links()[std::size_t(y)], layout.row(y));
        if (!layout.absent(layout.down(y)))
            listen(*machine.distribution().links().at(downs++), layout.down(y));
    }
    Array& array = machine.array();
    for (std::size_t i = 0; i < array.links().size(); ++i) {
        if (array.side_of(i) != Side::east) continue;
        const std::size_t sink = array.sink_of(i);  // row by row
        const int x = int(sink % std::size_t(layout.width));
        const int y = int(sink / std::size_t(layout.width));
        listen(array.links()[i], layout.east(x - 1, y));
    }
}

MachineTap::~MachineTap() {
    for (Link* link : links_) link->set_observer(nullptr);
}

}  // namespace raycell::loading
