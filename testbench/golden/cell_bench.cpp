#include "testbench/golden/cell_bench.hpp"

#include <algorithm>
#include <sstream>

#include "model/loading/loading.hpp"
#include "testbench/golden/messages.hpp"

namespace raycell {
namespace {

std::string line_of(const GoldenEvent& event) {
    return event.line > 0 ? " (line " + std::to_string(event.line) + ")" : "";
}

}  // namespace

CellBench::CellBench(sc_core::sc_module_name name, const CellSetup& setup, std::vector<GoldenEvent> events,
                     Cycle last)
    : sc_module(name),
      setup_(setup),
      scheduler_("scheduler", sc_core::sc_time(1e3 / setup.machine.clock_mhz, sc_core::SC_NS)),
      picture_(setup.scene.frame.width, setup.scene.frame.height),
      environment_(setup_.scene, setup_.picture, setup_.machine, scheduler_, picture_),
      module_("cell", environment_, setup.x, setup.y),
      words_(environment_.context.arithmetic, setup_.picture),
      packing_(environment_.context, setup_.machine),
      last_(last) {
    SC_METHOD(drive);
    sensitive << wake_;
    dont_initialize();
    make_links();
    for (GoldenEvent& event : events) {
        check(event);
        if (event.what == GoldenEvent::What::pixel) {
            pixels_.push_back(std::move(event));
        } else if (event.expected()) {
            const Key key{int(event.what), event.side, event.index};
            expected_[key].push_back(std::move(event));
        } else {
            stimuli_.push_back(std::move(event));
        }
    }
    scheduler_.set_limit(last);
    scheduler_.set_watch(&CellBench::begin_cycle, this);
}

/// Throws GoldenError, naming the line, for an event that can't be of this cell.
void CellBench::check(const GoldenEvent& event) {
    const auto fail = [&](const std::string& what) {
        throw GoldenError("'" + text_of(event).substr(0, 80) + "'" + line_of(event) + ": " + what);
    };
    const bool message = event.what == GoldenEvent::What::in || event.what == GoldenEvent::What::out;
    const bool buffer =
        message || event.what == GoldenEvent::What::take || event.what == GoldenEvent::What::free;
    if (!buffer) return;
    const bool load = event.side == GoldenEvent::load_link;
    if ((load ? !load_ : !setup_.linked[std::size_t(event.side)]) ||
        event.index >= (load ? 1 : environment_.classes.count))
        fail("the cell has no such buffer");
    if (!message) return;
    std::string wrong;
    try {
        const Message read = message_of(event);
        wrong = packing_.objection(read, event.bits);
        give_back(read, environment_.pools);
    } catch (const GoldenError& error) {
        wrong = error.what();
    }
    if (!wrong.empty()) fail(wrong);
}

Message CellBench::message_of(const GoldenEvent& event) {
    const KindRules rules{setup_.picture.shadows, environment_.phase == Phase::precast};
    return read_message(words_, event.tokens, event.remarks, rules, environment_.pools);
}

void CellBench::make_links() {
    const auto make = [&](int classes, const std::string& link_name) {
        auto link = std::make_unique<Link>(scheduler_, classes, setup_.machine.buffer_depth);
        link->set_name(link_name);
        link->set_observer(this);
        return link;
    };
    const std::string at = std::to_string(setup_.x) + "_" + std::to_string(setup_.y);
    for (int side = 0; side < side_count; ++side) {
        const auto i = std::size_t(side);
        if (!setup_.linked[i]) continue;
        const int x = setup_.x + step_x(Side(side));
        const int y = setup_.y + step_y(Side(side));
        const bool border = x < 0 || x >= setup_.picture.width || y < 0 || y >= setup_.picture.height;
        // A link draws its random stalls by its name. Those of incoming messages are in their cycles already.
        out_[i] = make(environment_.classes.count,
                       border ? "border_" + at + ".out" : "cell_" + at + "." + name_of_side(side));
        environment_.stall(*out_[i], out_[i]->name());
        out_[i]->connect_source(cell());
        in_[i] = make(environment_.classes.count, std::string("in.") + name_of_side(side));
        in_[i]->connect_sink(cell());
        module_.in[i].bind(*in_[i]);
        module_.out[i].bind(*out_[i]);
    }
    if (setup_.x > 0) return;
    load_ = make(1, "in.load");
    load_->connect_sink(cell());
    module_.load_in.bind(*load_);
}

// ---- what the cell is told

void CellBench::schedule_next() {
    if (next_ == stimuli_.size() || given_up_) return;
    const Cycle cycle = stimuli_[next_].cycle;
    if (cycle > last_) return;
    scheduler_.wake(*this, cycle);
    for (std::size_t i = next_; i < stimuli_.size() && stimuli_[i].cycle == cycle; ++i) {
        const GoldenEvent& event = stimuli_[i];
        if (event.what == GoldenEvent::What::phase) scheduler_.wake(cell(), cycle);
        if (event.what == GoldenEvent::What::drain) scheduler_.wake(cell(), cycle + 1);
    }
}

/// Applies phase and drain events, before anything else runs in the cycle.
bool CellBench::begin_cycle(void* self, Cycle now) {
    auto& bench = *static_cast<CellBench*>(self);
    for (; bench.next_change_ < bench.stimuli_.size(); ++bench.next_change_) {
        const GoldenEvent& event = bench.stimuli_[bench.next_change_];
        if (event.cycle > now) break;
        if (event.what == GoldenEvent::What::phase || event.what == GoldenEvent::What::drain)
            bench.change(event, now);
    }
    return true;
}

void CellBench::change(const GoldenEvent& event, Cycle now) {
    if (event.what == GoldenEvent::What::drain) {
        environment_.draining = event.tokens[0] == "1";
        return;
    }
    if (event.tokens[0] != "precast" && event.tokens[0] != "trace") {
        report(event, "phase '" + event.tokens[0].substr(0, 20) + "': expected precast or trace");
        given_up_ = true;
        return;
    }
    environment_.phase = event.tokens[0] == "precast" ? Phase::precast : Phase::trace;
    environment_.phase_start = now - 1;
    if (!shadow_bits_ && setup_.picture.shadows != Shadows::per_hit) reset_shadow_bits(cell().store());
    shadow_bits_ = true;
    cell().begin_phase();
}

void CellBench::drive() {
    const Cycle now = scheduler_.now();
    for (; next_ < stimuli_.size() && stimuli_[next_].cycle <= now && !given_up_; ++next_) {
        const GoldenEvent& event = stimuli_[next_];
        if (event.what == GoldenEvent::What::in) send(event);
        if (event.what == GoldenEvent::What::free) free(event);
    }
    schedule_next();
}

void CellBench::send(const GoldenEvent& event) {
    Link& link = event.side == GoldenEvent::load_link ? *load_ : *in_[std::size_t(event.side)];
    Cycle retry = never;
    given_up_ = true;
    if (!link.can_send(event.index, retry)) {
        report(event, std::string("a message comes in, but ") +
                          (retry == never ? "the cell has not taken the one before out of its buffer"
                                          : "the wires are busy, or the buffer was full in this cycle"));
        return;
    }
    Message message;
    try {
        message = message_of(event);
    } catch (const GoldenError& error) {
        report(event, error.what());
        return;
    }
    const std::string wrong = objection(message, event.index);
    if (!wrong.empty()) {
        report(event, wrong);
        return;
    }
    given_up_ = false;
    link.send(event.index, message, event.cycles);
}

void CellBench::free(const GoldenEvent& event) {
    Link& link = *out_[std::size_t(event.side)];
    const Message message = link.front(event.index);
    if (message.kind == Message::Kind::none) {
        report(event, "the neighbour takes a message that the cell has not sent");
        given_up_ = true;
        return;
    }
    link.pop(event.index);
    give_back(message, environment_.pools);
}

/// Why a message must not be sent to the cell, because it refers to something that does not exist; else
/// empty.
std::string CellBench::objection(const Message& message, int index) const {
    const BufferClasses& classes = environment_.classes;
    const auto pixels = std::uint64_t(environment_.width()) * std::uint64_t(environment_.height());
    const auto at_home = [&](const auto& m) {
        return m.home_x < environment_.width() && m.home_y < environment_.height() && pixel_of(m.id) < pixels;
    };
    switch (message.kind) {
        case Message::Kind::ray: {
            const Ray& ray = message.ray->ray;
            if (!at_home(ray)) return "a ray of a pixel or a home outside the array";
            if (ray.generation > setup_.picture.max_depth + is_shadow(ray.kind))
                return "a ray of a generation beyond --max-depth";
            if (index != classes.ray(ray)) return "a ray of another direction than its buffer's class";
            // Its answer comes here, if it is of this cell.
            return objection_to_answer(
                answer_to(ray, is_shadow(ray.kind) ? Answer::Kind::lit : Answer::Kind::intensity));
        }
        case Message::Kind::answer:
            if (!at_home(*message.answer)) return "an answer of a pixel or a home outside the array";
            if (index != classes.answer) return "an answer in a buffer for rays";
            return objection_to_answer(*message.answer);
        case Message::Kind::load: {
            const LoadItem& item = *message.load;
            if (index != 0) return "a load message in another class than 0";
            const std::size_t objects = environment_.context.objects.size();
            if (item.kind == LoadItem::Kind::features && item.object >= objects) return "no such object";
            if (item.kind != LoadItem::Kind::span) return "";
            if (item.span.object >= objects) return "a span of an object that there is not";
            if (item.span.x < setup_.x || item.span.last < item.span.x ||
                item.span.last >= environment_.width())
                return "a span that is over, or reaches out of the array";
            return "";
        }
        case Message::Kind::none:
            break;
    }
    return "nothing";
}

std::string CellBench::objection_to_answer(const Answer& answer) const {
    if (answer.home_x != setup_.x || answer.home_y != setup_.y) return "";
    const Cell& cell = module_.cell();
    switch (answer.ray_kind) {
        case RayKind::primary:
            return "";
        case RayKind::memo:
        case RayKind::precast:
            return answer.slot < cell.store().lit.size() ? "" : "an answer for a voxel that there is not";
        case RayKind::reflected:
        case RayKind::refracted:
            if (answer.child > 1) return "an answer of a child other than 0 and 1";
            break;
        case RayKind::shadow:
            break;
    }
    return answer.slot < cell.ray_store().touched() ? "" : "an answer for a slot that was never used";
}

// ---- what the cell does

void CellBench::report(const GoldenEvent& event, const std::string& what) {
    if (failures_.size() >= most_failures_) return;
    failures_.push_back("cycle " + std::to_string(event.cycle) + line_of(event) + ": " + what);
}

void CellBench::sent(const Link& link, int index, const Message& message, int cycles, Cycle now) {
    for (int side = 0; side < side_count; ++side) {
        if (out_[std::size_t(side)].get() != &link) continue;
        GoldenEvent event{
            GoldenEvent::What::out, now, side, index, cycles, tokens_of(text_of(words_, message)), 0};
        event.bits = packing_.packed(message);
        event.remarks = tokens_of(remarks_of(message));
        compare(event);
    }
}

void CellBench::popped(const Link& link, int index, const Message&, Cycle now) {
    for (int side = 0; side <= GoldenEvent::load_link; ++side) {
        const Link* in = side == GoldenEvent::load_link ? load_.get() : in_[std::size_t(side)].get();
        if (in == &link) compare({GoldenEvent::What::take, now, side, index, 0, {}, 0});
    }
}

void CellBench::compare(const GoldenEvent& event) {
    auto& queue = expected_[{int(event.what), event.side, event.index}];
    if (queue.empty()) {
        report(event, "nothing was expected any more, but: " + text_of(event));
        return;
    }
    const std::string wrong = difference(event, queue.front());
    if (wrong.empty()) {
        ++matched_;
    } else {
        GoldenEvent at = event;
        at.line = queue.front().line;
        report(at, wrong + "; it did: " + text_of(event));
    }
    queue.pop_front();
}

std::string CellBench::difference(const GoldenEvent& is, const GoldenEvent& expected) const {
    const std::string where = std::string(is.what == GoldenEvent::What::out ? "out " : "take ") +
                              name_of_side(is.side) + " " + std::to_string(is.index) + ": ";
    if (is.cycle != expected.cycle) return where + "expected in cycle " + std::to_string(expected.cycle);
    if (is.cycles != expected.cycles)
        return where + "takes " + std::to_string(is.cycles) + " cycles over the link, expected " +
               std::to_string(expected.cycles);
    const bool packed = !is.bits.empty() && !expected.bits.empty();
    // An object's number is in no bits, but which features come next is told by it.
    const bool numbered = !is.tokens.empty() && is.tokens[0] == "features" && is.tokens != expected.tokens;
    if (packed ? is.bits == expected.bits && !numbered : is.tokens == expected.tokens) return "";
    const std::string field = raycell::difference(words_, is.tokens, expected.tokens);
    return where + (field.empty() ? "expected: " + text_of(expected) : field);
}

void CellBench::compare_pixel() {
    const Pixel& pixel = picture_.at(setup_.x, setup_.y);
    const Format& format = words_.formats().intensity;
    GoldenEvent is{GoldenEvent::What::pixel, environment_.phase_start + pixel.cycle, 0, 0, 0, {}, 0};
    for (int channel = 0; channel < 3; ++channel)
        is.tokens.push_back(words_.word(format, pixel.colour[channel]));
    if (pixel.cycle == 0) is.tokens.clear();
    for (const GoldenEvent& expected : pixels_) {
        if (pixel.cycle == 0) {
            report(expected, "the cell's own pixel was expected to be complete");
        } else if (is.cycle != expected.cycle || is.tokens != expected.tokens) {
            report(expected, "expected '" + text_of(expected) + "', the cell has '" + text_of(is) + "'");
        } else {
            ++matched_;
        }
    }
    if (pixels_.empty() && pixel.cycle != 0) report(is, "no pixel was expected, but: " + text_of(is));
}

std::vector<std::string> CellBench::run(std::size_t most) {
    most_failures_ = most;
    schedule_next();
    sc_core::sc_start();
    if (given_up_) return failures_;  // missing events would only be consequences
    std::vector<const GoldenEvent*> missing;
    for (const auto& [key, queue] : expected_) {
        if (!queue.empty()) missing.push_back(&queue.front());
    }
    std::sort(missing.begin(), missing.end(),
              [](const GoldenEvent* a, const GoldenEvent* b) { return a->cycle < b->cycle; });
    for (const GoldenEvent* event : missing) report(*event, "expected, but never came: " + text_of(*event));
    compare_pixel();
    return failures_;
}

}  // namespace raycell
