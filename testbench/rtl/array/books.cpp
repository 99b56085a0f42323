#include "testbench/rtl/array/books.hpp"

#include <algorithm>
#include <stdexcept>

#include "testbench/golden/messages.hpp"

namespace raycell {
namespace {

using What = rtl::CellAct::What;

/// Whether digits that are filled up with zeros are these.
bool same_digits(const std::string& filled, const std::string& digits) {
    return filled.compare(0, digits.size(), digits) == 0 &&
           filled.find_first_not_of('0', digits.size()) == std::string::npos;
}

}  // namespace

RtlBooks::RtlBooks(Environment& environment, Cell& cell, rtl::ArrayCell& rtl, Disagreements& disagreements)
    : env_(environment),
      cell_(cell),
      rtl_(rtl),
      disagreements_(disagreements),
      packing_(environment.context, environment.machine),
      words_(environment.context.arithmetic, environment.settings),
      wire_(environment.settings, environment.machine, environment.context.arithmetic.formats()),
      load_wire_(environment.settings, environment.context.arithmetic.formats()) {}

void RtlBooks::enter(const rtl::CellAct& act) {
    switch (act.what) {
        case What::load:
            return load(act);
        case What::loaded:
            return loaded();
        case What::launch:
            return act.place.side == rtl::slot_register ? launch_child(act.place.index) : launch();
        case What::answer:
            return move_answer(act);
        case What::ray:
            return move_ray(act);
        case What::test:
            return test(act.place);
        case What::reply:
            return reply(act);
        case What::shades:
            return begin_job(act);
        case What::shaded:
            return end_job(act);
    }
}

void RtlBooks::disagree(const std::string& text) { disagreements_.add(cell_.x(), cell_.y(), now(), text); }

void RtlBooks::fail(const std::string& text) const {
    throw std::runtime_error("cell (" + std::to_string(cell_.x()) + ", " + std::to_string(cell_.y()) +
                             "), cycle " + std::to_string(now()) + ": " + text);
}

std::string RtlBooks::digits_of(const Message& message) const {
    const auto bits = packing_.bits_of(message);
    if (!bits) fail("a message comes that has no code: " + text_of(words_, message));
    return bits->hex();
}

std::string RtlBooks::viewer_digits() const { return load_wire_.pack(viewer_of(env_.context)).hex(); }

void RtlBooks::record(CellEvent event, std::uint32_t hashed, std::uint64_t ray, std::uint32_t detail) {
    cell_.meter().note(now(), event, hashed);
    tell(event, ray, detail);
}

void RtlBooks::tell(CellEvent event, std::uint64_t ray, std::uint32_t detail) const {
    if (env_.meters.observer) env_.meters.observer->cell_event(cell_, now(), event, ray, detail);
}

// ---- messages that leave

WireBits RtlBooks::bits_of(const rtl::CellMessage& sent) {
    WireBits bits;
    for (const char c : sent.digits) bits.put(std::uint64_t(c <= '9' ? c - '0' : c - 'a' + 10), 4);
    return bits;
}

std::string RtlBooks::goal_name(int to) {
    if (to == rtl::to_home) return "home";
    return to == rtl::to_nobody ? "nobody" : name_of(Side(to));
}

rtl::CellMessage RtlBooks::outgoing(int side, int index, int cycles) {
    const rtl::CellMessage sent = rtl_.sent(side);
    Link* link = cell_.output(Side(side));
    const std::string where = std::string("output ") + name_of(Side(side)) + " class ";
    if (!link) fail(where + std::to_string(sent.index) + ": there is no link");
    if (sent.index < 0 || sent.index >= env_.classes.count)
        fail(where + std::to_string(sent.index) + ": expected one of " + std::to_string(env_.classes.count));
    if (sent.index != index)
        disagree(where + std::to_string(sent.index) + ": expected class " + std::to_string(index));
    Cycle retry = never;
    if (!link->can_send(sent.index, retry))
        fail(where + std::to_string(sent.index) + ": it sends, but " +
             (link->room(sent.index) == Link::Room::full ? "the far buffer is full" : "the wires are busy"));
    if (sent.cycles != cycles)
        disagree(where + std::to_string(sent.index) + ": cycles on the link are " +
                 std::to_string(sent.cycles) + ", expected " + std::to_string(cycles));
    return sent;
}

/// Names the first field in which what is sent is not what the model would have sent.
void RtlBooks::compare(const Message& expected, const rtl::CellMessage& sent) {
    const std::string digits = digits_of(expected);
    if (same_digits(sent.digits, digits)) return;
    std::string field;
    if (expected.kind != Message::Kind::load) {
        try {
            field = difference(words_, tokens_of(packing_.text_of_bits(sent.digits.substr(0, digits.size()))),
                               tokens_of(text_of(words_, expected)));
        } catch (const std::exception&) {
            field.clear();  // not even of this type
        }
    }
    const std::string remarks = remarks_of(expected);
    disagree(text_of(words_, expected).substr(0, text_of(words_, expected).find(' ')) +
             (remarks.empty() ? "" : " (" + remarks + ")") + ": " +
             (field.empty() ? "bits are " + sent.digits + ", expected " + digits : field));
}

/// What no wire carries: it is that of the message in whose place this one stood, unless the cell says it.
std::uint64_t RtlBooks::id_of(const rtl::CellMessage& sent, std::uint64_t of_place) const {
    return rtl_.has_ids() ? sent.id : of_place;
}

std::uint64_t RtlBooks::id_of(const Message& message) {
    if (message.kind == Message::Kind::ray) return message.ray->ray.id;
    return message.kind == Message::Kind::answer ? message.answer->id : 0;
}

// ---- loading

/// The last voxel is in order.
void RtlBooks::loaded() {
    Wakeup later;
    if (!cell_.loading_units().closes(now(), later))
        disagree("it is loaded, expected in cycle " + std::to_string(later.next));
    cell_.meter().loaded(env_.meters.counters, now());
}

void RtlBooks::load(const rtl::CellAct& act) {
    Link& from = *input(act.place.side);
    LoadItem* item = from.front(0).load;
    if (!item) fail("it takes a load message, and none is there");
    const bool ends = LoadingUnits::ends_at(*item, cell_.x(), env_.width());
    const LoadItem::Kind kind = item->kind;
    if (ends != (act.to == rtl::to_nobody))
        fail(std::string("load message '") + name_of(kind) + "' goes to " + goal_name(act.to) +
             ", expected " + (ends ? "nobody" : "the east"));
    cell_.meter().load_passed(env_.meters.counters, ends);
    const bool makes = LoadingUnits::makes_voxel(*item, cell_.x());
    const std::uint32_t lines = LoadingUnits::take(*item, cell_.x(), cell_.store(), env_.context);
    from.pop(0);
    if (makes) keep_span(cell_.loading_units(), lines, cell_.store(), env_, cell_.meter());
    if (kind == LoadItem::Kind::end_of_scene) {
        cell_.loading_units().close();
        if (!rtl_.makes_voxels()) loaded();
    }
    if (ends) {
        env_.pools.loads.give_back(item);
    } else {
        const int cycles = env_.cycles_for(env_.load_bits(*item));
        const rtl::CellMessage sent = outgoing(int(Side::east), 0, cycles);
        compare(Message(item), sent);
        if (kind == LoadItem::Kind::span) {
            const std::uint32_t object = item->span.object;  // that whose features came last
            item->span = load_wire_.unpack_span(bits_of(sent));
            item->span.object = object;
        }
        if (env_.load_wire) ++env_.meters.counters.packed_load;
        cell_.output(Side::east)->send(0, Message(item), sent.cycles);
    }
    record(CellEvent::load, std::uint32_t(kind), 0, std::uint32_t(kind));
}

}  // namespace raycell
