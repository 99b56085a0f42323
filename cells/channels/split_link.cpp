#include "cells/channels/split_link.hpp"

#include <stdexcept>
#include <type_traits>

namespace raycell {
namespace {

/// Kinds of records. The first word of a record is half link number · 256 + class · 16 + kind.
enum class Record : std::uint32_t {
    read = 1,  ///< a message has left the sink's buffer: the source has room
    ray,       ///< an untested ray
    ray_out,   ///< a tested ray that goes over the array's border
    answer,
    trapeze,    ///< a load message with a trapeze
    broadcast,  ///< another load message
};

struct RayRecord {
    Ray ray;
    std::uint64_t launched;
    std::uint32_t hops;
    std::uint32_t cycles;
};
struct RayOutRecord {
    RayRecord ray;
    Crossing crossing;
};
struct AnswerRecord {
    Answer answer;
    std::uint32_t cycles;
};
struct TrapezeRecord {  // or its surface
    LoadItem::Kind kind;
    Trapeze trapeze;
    CornerIntensities intensities;
    std::uint32_t cycles;
};
struct BroadcastRecord {
    LoadItem::Kind kind;
    std::uint32_t object;
    std::uint32_t cycles;
};

RayPacket* packet_of(const RayRecord& record, MessagePools& pools) {
    RayPacket* packet = pools.rays.take();
    packet->ray = record.ray;
    packet->launched = record.launched;
    packet->hops = record.hops;
    return packet;
}

RayRecord record_of(const RayPacket& packet, int cycles) {
    return {packet.ray, packet.launched, packet.hops, std::uint32_t(cycles)};
}

}  // namespace

void SplitLinks::End::sent(const Link&, int index, const Message& message, int cycles, Cycle) {
    if (source) owner_.put_message(number, index, message, cycles);
}

void SplitLinks::End::popped(const Link&, int index, const Message&, Cycle) {
    if (!source) owner_.put(number << 8 | std::uint32_t(index) << 4 | std::uint32_t(Record::read));
}

Link& SplitLinks::make_source(Scheduler& scheduler, int classes, int depth, std::uint32_t used) {
    made_.push_back(std::make_unique<Link>(scheduler, classes, depth, used));
    add(*made_.back(), true);
    return *made_.back();
}

Link& SplitLinks::make_sink(Scheduler& scheduler, int classes, int depth) {
    made_.push_back(std::make_unique<Link>(scheduler, classes, depth));
    add(*made_.back(), false);
    return *made_.back();
}

void SplitLinks::add_source(Link& half) { add(half, true); }
void SplitLinks::add_sink(Link& half) { add(half, false); }

void SplitLinks::add(Link& half, bool source) {
    ends_.push_back(std::make_unique<End>(*this, half, std::uint32_t(ends_.size()), source));
    half.set_observer(ends_.back().get());
}

void SplitLinks::set_prefix(std::size_t prefix) {
    prefix_ = prefix;
    out_.resize(prefix);
}

template <typename T>
void SplitLinks::put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    out_.insert(out_.end(), bytes, bytes + sizeof(T));
}

void SplitLinks::put_message(std::uint32_t number, int index, const Message& message, int cycles) {
    const auto begin = [&](Record kind) {
        put(number << 8 | std::uint32_t(index) << 4 | std::uint32_t(kind));
    };
    const auto ticks = std::uint32_t(cycles);
    gone_.push_back(message);
    switch (message.kind) {
        case Message::Kind::ray:
            if (message.ray->stage == RayPacket::Stage::untested) {
                begin(Record::ray);
                put(record_of(*message.ray, cycles));
            } else {
                begin(Record::ray_out);
                put(RayOutRecord{record_of(*message.ray, cycles), message.ray->visit.crossing});
            }
            break;
        case Message::Kind::answer:
            begin(Record::answer);
            put(AnswerRecord{*message.answer, ticks});
            break;
        case Message::Kind::load:
            if (message.load->kind == LoadItem::Kind::trapeze ||
                message.load->kind == LoadItem::Kind::surface) {
                begin(Record::trapeze);
                put(TrapezeRecord{message.load->kind, message.load->trapeze, message.load->intensities,
                                  ticks});
            } else {
                begin(Record::broadcast);
                put(BroadcastRecord{message.load->kind, message.load->object, ticks});
            }
            break;
        case Message::Kind::none:
            break;
    }
}

void SplitLinks::clear(MessagePools& pools) {
    for (const Message& message : gone_) {
        if (message.kind == Message::Kind::ray) pools.rays.give_back(message.ray);
        if (message.kind == Message::Kind::answer) pools.answers.give_back(message.answer);
        if (message.kind == Message::Kind::load) pools.loads.give_back(message.load);
    }
    gone_.clear();
    out_.resize(prefix_);
}

void SplitLinks::deliver(const std::byte* data, std::size_t size, MessagePools& pools, int answers_later) {
    ByteReader records(data, size);
    while (!records.at_end()) {
        const auto word = records.get<std::uint32_t>();
        const int index = int(word >> 4 & 15U);
        if (word >> 8 >= ends_.size())
            throw std::logic_error("internal error: another rank names half link " +
                                   std::to_string(word >> 8) + " of " + std::to_string(ends_.size()));
        Link& link = *ends_[word >> 8]->link;
        switch (Record(word & 15U)) {
            case Record::read:
                link.pop(index);
                break;
            case Record::ray: {
                const auto record = records.get<RayRecord>();
                link.send(index, Message(packet_of(record, pools)), int(record.cycles));
                break;
            }
            case Record::ray_out: {
                const auto record = records.get<RayOutRecord>();
                RayPacket* packet = packet_of(record.ray, pools);
                packet->stage = RayPacket::Stage::decided;
                packet->visit.crossing = record.crossing;
                link.send(index, Message(packet), int(record.ray.cycles));
                break;
            }
            case Record::answer: {
                const auto record = records.get<AnswerRecord>();
                Answer* answer = pools.answers.take();
                *answer = record.answer;
                link.send(index, Message(answer), int(record.cycles), answers_later);
                break;
            }
            case Record::trapeze: {
                const auto record = records.get<TrapezeRecord>();
                LoadItem* item = pools.loads.take();
                item->kind = record.kind;
                item->trapeze = record.trapeze;
                item->intensities = record.intensities;
                link.send(index, Message(item), int(record.cycles));
                break;
            }
            case Record::broadcast: {
                const auto record = records.get<BroadcastRecord>();
                LoadItem* item = pools.loads.take();
                item->kind = record.kind;
                item->object = record.object;
                link.send(index, Message(item), int(record.cycles));
                break;
            }
            default:
                throw std::logic_error("internal error: a record of kind " + std::to_string(word & 15U) +
                                       " from another rank");
        }
    }
}

}  // namespace raycell
