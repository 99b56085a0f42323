#include "testbench/golden/recorder.hpp"

#include "testbench/golden/messages.hpp"

namespace raycell {

GoldenRecorder::GoldenRecorder(sc_core::sc_module_name name, Machine& machine, std::vector<Target> targets,
                               std::string configuration)
    : sc_module(name),
      machine_(machine),
      words_(machine.environment().context.arithmetic, machine.environment().settings),
      packing_(machine.environment().context, machine.environment().machine),
      memory_(words_.formats(), packing_.widest()),
      targets_(std::move(targets)),
      configuration_(std::move(configuration)) {}

/// Attaches here, because modules' ports know their links only now.
void GoldenRecorder::start_of_simulation() {
    for (std::size_t target = 0; target < targets_.size(); ++target) attach(target);
}

void GoldenRecorder::attach(std::size_t target) {
    const Cell& cell = *targets_[target].cell;
    const Environment& env = machine_.environment();
    CellSetup setup;
    setup.x = cell.x();
    setup.y = cell.y();
    setup.machine = env.machine;
    for (int side = 0; side < side_count; ++side) {
        Link* in = cell.input(Side(side));
        setup.linked[std::size_t(side)] = in;
        if (!in) continue;
        watch(*in, {target, true, side});
        watch(*cell.output(Side(side)), {target, false, side});
    }
    Link* load = cell.load_input();
    if (load && load != cell.input(Side::west)) watch(*load, {target, true, GoldenEvent::load_link});
    std::fputs(setup_text(setup, env.context, configuration_).c_str(), targets_[target].file);
    for (std::FILE* memory : {targets_[target].memory_in, targets_[target].memory_out}) {
        if (memory) std::fputs(memory_.first_line().c_str(), memory);
    }
}

void GoldenRecorder::watch(Link& link, const Role& role) {
    roles_[&link].push_back(role);
    links_.push_back(&link);
    link.set_observer(this);
}

void GoldenRecorder::write(std::size_t target, const GoldenEvent& event) {
    const Target& files = targets_[target];
    std::fputs((text_of(event) + "\n").c_str(), files.file);
    std::FILE* memory = event.expected() ? files.memory_out : files.memory_in;
    if (memory) std::fputs(memory_.line(event).c_str(), memory);
}

void GoldenRecorder::sent(const Link& link, int index, const Message& message, int cycles, Cycle now) {
    for (const Role& role : roles_.at(&link)) {
        const auto what = role.incoming ? GoldenEvent::What::in : GoldenEvent::What::out;
        GoldenEvent event{what, now, role.side, index, cycles, {text_of(words_, message)}, 0};
        if (const auto bits = packing_.bits_of(message)) {
            event.bits = bits->hex();
            event.bit_count = bits->size();
        }
        const std::string remarks = remarks_of(message);
        if (!remarks.empty()) event.remarks = {remarks};
        write(role.target, event);
    }
}

void GoldenRecorder::popped(const Link& link, int index, const Message&, Cycle now) {
    for (const Role& role : roles_.at(&link)) {
        const auto what = role.incoming ? GoldenEvent::What::take : GoldenEvent::What::free;
        write(role.target, {what, now, role.side, index, 0, {}, 0});
    }
}

void GoldenRecorder::phase_begins(Phase phase, Cycle first) {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        write(i,
              {GoldenEvent::What::phase, first, 0, 0, 0, {phase == Phase::precast ? "precast" : "trace"}, 0});
    }
}

void GoldenRecorder::draining(bool on, Cycle now) {
    for (std::size_t i = 0; i < targets_.size(); ++i)
        write(i, {GoldenEvent::What::drain, now, 0, 0, 0, {on ? "1" : "0"}, 0});
}

void GoldenRecorder::finish() {
    const Environment& env = machine_.environment();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const Cell& cell = *targets_[i].cell;
        const Pixel& pixel = env.picture.at(cell.x(), cell.y());
        if (env.phase == Phase::trace && pixel.cycle != 0) {
            GoldenEvent event{GoldenEvent::What::pixel, env.phase_start + pixel.cycle, 0, 0, 0, {}, 0};
            for (int channel = 0; channel < 3; ++channel)
                event.tokens.push_back(words_.word(words_.formats().intensity, pixel.colour[channel]));
            write(i, event);
        }
        const Cycle last = env.scheduler.now();
        std::fprintf(targets_[i].file, "%llu end\n", static_cast<unsigned long long>(last));
        for (std::FILE* memory : {targets_[i].memory_in, targets_[i].memory_out}) {
            if (memory) std::fputs(memory_.last_line(last).c_str(), memory);
        }
    }
    for (Link* link : links_) link->set_observer(nullptr);
}

}  // namespace raycell
