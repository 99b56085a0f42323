// A cell module between a user's own channels, and links as channels for a module that is sensitive to its
// ports.
#include <deque>

#include "lone_cell.hpp"

namespace raycell {
namespace {

/// A plain FIFO with the interfaces of a link: one message at a time on its wires, buffers of fixed depth.
class PlainChannel : public sc_core::sc_prim_channel, public LinkIn, public LinkOut, public Client {
  public:
    PlainChannel(Scheduler& scheduler, int depth) : scheduler_(scheduler), depth_(std::size_t(depth)) {}

    bool can_send(int index, Cycle& retry) override {
        const Buffer& buffer = buffers_[std::size_t(index)];
        const Cycle now = scheduler_.now();
        const bool just_read = buffer.read == now && buffer.reads > 0;
        if (buffer.held.size() + (just_read ? buffer.reads : 0) >= depth_) {
            if (just_read) {
                retry = std::min(retry, now + 1);
            } else {
                refused_ = true;
            }
            return false;
        }
        if (free_ > now) retry = std::min(retry, free_);
        return free_ <= now;
    }
    void send(int index, const Message& message, int cycles, int later) override {
        free_ = scheduler_.now() + Cycle(cycles);
        buffers_[std::size_t(index)].held.push_back({message, free_});
        scheduler_.wake(*this, free_);
        if (later > 0) scheduler_.wake(*this, free_ + Cycle(later));
    }
    Message front(int index) const override {
        const Buffer& buffer = buffers_[std::size_t(index)];
        const bool arrived = !buffer.held.empty() && buffer.held.front().second <= scheduler_.now();
        return arrived ? buffer.held.front().first : Message();
    }
    Cycle arrival(int index) const override { return buffers_[std::size_t(index)].held.front().second; }
    void pop(int index) override {
        Buffer& buffer = buffers_[std::size_t(index)];
        const Cycle now = scheduler_.now();
        buffer.reads = buffer.read == now ? buffer.reads + 1 : 1;
        buffer.read = now;
        buffer.held.pop_front();
        if (refused_) scheduler_.wake(*this, now + 1);
        refused_ = false;
    }
    int occupancy(int index) const override { return int(buffers_[std::size_t(index)].held.size()); }
    const sc_core::sc_event& default_event() const override { return event_; }
    void activate() override { event_.notify(); }

  private:
    struct Buffer {
        std::deque<std::pair<Message, Cycle>> held;
        Cycle read = never;
        std::size_t reads = 0;
    };
    Scheduler& scheduler_;
    std::size_t depth_;
    std::array<Buffer, Link::most_classes> buffers_;
    Cycle free_ = 0;
    bool refused_ = false;
    sc_core::sc_event event_;
};

/// A cell alone between links or between plain channels, under the same traffic: rays and answers from all
/// sides, sent as soon as possible and read late.
struct Traffic {
    Traffic(Scheduler& scheduler, const char* name, Networks networks, bool plain_channels)
        : scene(LoneCell::empty(100)), picture(3, 3) {
        settings.width = settings.height = 3;
        settings.exterior = ExteriorMode::none;
        machine.networks = networks;
        environment = std::make_unique<Environment>(scene, settings, machine, scheduler, picture);
        environment->phase = Phase::trace;
        cell = std::make_unique<CellModule>(name, *environment, 1, 1);
        for (int side = 0; side < side_count; ++side) {
            const auto i = std::size_t(side);
            if (plain_channels) {
                for (int way = 0; way < 2; ++way)
                    channels.push_back(std::make_unique<PlainChannel>(scheduler, machine.buffer_depth));
                join(i, *channels[channels.size() - 2], *channels.back());
            } else {
                for (int way = 0; way < 2; ++way)
                    links.push_back(
                        std::make_unique<Link>(scheduler, environment->classes.count, machine.buffer_depth));
                links[links.size() - 2]->connect_sink(cell->cell());
                links.back()->connect_source(cell->cell());
                join(i, *links[links.size() - 2], *links.back());
            }
        }
    }
    template <typename Channel>
    void join(std::size_t side, Channel& from, Channel& to) {
        cell->in[side].bind(from);
        cell->out[side].bind(to);
        sent_to.push_back(&from);
        read_from.push_back(&to);
    }
    /// Plays one cycle of the neighbours.
    void act(Cycle now) {
        for (std::size_t side = 0; side < side_count; ++side) {
            Cycle retry = never;
            const dvec3 away{side == 0   ? -1.0
                             : side == 2 ? 1.0
                                         : 0.1,
                             side == 1   ? -1.0
                             : side == 3 ? 1.0
                                         : 0.1,
                             0.2};
            Ray ray = lone_ray({0.5, 0.5, 10}, away);
            ray.id = now * 8 + side;
            const int index = environment->classes.ray(ray);
            const bool in_time = now % 700 < 400 && now < 3000;
            const bool answers_turn = (now + side) % 3 == 0;
            if (in_time && !answers_turn && sent_to[side]->can_send(index, retry)) {
                RayPacket* packet = environment->pools.rays.take();
                packet->ray = ray;
                sent_to[side]->send(index, Message(packet), 7);
            } else if (in_time && answers_turn &&
                       sent_to[side]->can_send(environment->classes.answer, retry)) {
                Answer* answer = environment->pools.answers.take();
                answer->home_x = side < 2 ? 2 : 0;
                answer->home_y = side % 2 ? 2 : 0;
                answer->id = ray.id;
                sent_to[side]->send(environment->classes.answer, Message(answer), 5);
            }
            for (int i = 0; i < environment->classes.count; ++i) {
                const Message head = read_from[side]->front(i);
                if (head.kind == Message::Kind::none || (now / 50) % 3 == 0) continue;
                read_from[side]->pop(i);
                log.push_back(now);
                log.push_back(side * 8 + std::uint64_t(i));
                log.push_back(head.kind == Message::Kind::ray ? head.ray->ray.id : head.answer->id);
            }
        }
    }

    CellScene scene;
    PictureSettings settings;
    MachineSettings machine = estimated_machine();
    Picture picture;
    std::unique_ptr<Environment> environment;
    std::unique_ptr<CellModule> cell;
    std::vector<std::unique_ptr<PlainChannel>> channels;
    std::vector<std::unique_ptr<Link>> links;
    std::vector<LinkIn*> read_from;
    std::vector<LinkOut*> sent_to;
    std::vector<std::uint64_t> log;  ///< cycle, output and class, ray: of each message that came out
};

class OwnChannels : public ::testing::TestWithParam<Networks> {};

TEST_P(OwnChannels, ChangeNothingOfWhatACellBetweenThemDoes) {
    expect_first_elaboration();
    Scheduler scheduler("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    Traffic linked(scheduler, "linked", GetParam(), false);
    Traffic plain(scheduler, "plain", GetParam(), true);
    Actor neighbours("neighbours", scheduler, [&](Cycle now) {
        linked.act(now);
        plain.act(now);
        return now < 6000 ? now + 1 : never;
    });
    scheduler.wake(neighbours, 1);
    sc_core::sc_start();
    EXPECT_GT(plain.log.size(), 3u * 300);
    EXPECT_EQ(plain.log, linked.log);
    EXPECT_EQ(plain.cell->cell().schedule_hash(), linked.cell->cell().schedule_hash());
    EXPECT_EQ(plain.environment->meters.counters.rays.ray_hops,
              linked.environment->meters.counters.rays.ray_hops);
    EXPECT_GT(plain.environment->meters.counters.rays.return_hops, 100u);
}

INSTANTIATE_TEST_SUITE_P(OfEachNetwork, OwnChannels,
                         ::testing::Values(Networks::shared, Networks::half, Networks::quadrant));

/// Reads what arrives and records when it may send, activated by its ports alone.
struct Listener : sc_core::sc_module {
    SC_HAS_PROCESS(Listener);
    Listener(sc_core::sc_module_name name, Scheduler& s) : sc_module(name), scheduler(s) {
        SC_METHOD(read);
        sensitive << in;
        dont_initialize();
        SC_METHOD(write);
        sensitive << out;
        dont_initialize();
    }
    void read() {
        while (in->front(0).kind != Message::Kind::none) {
            in->pop(0);
            read_in.push_back(scheduler.now());
        }
    }
    void write() {
        Cycle retry = never;
        if (out->can_send(0, retry)) told_in.push_back(scheduler.now());
    }
    sc_core::sc_port<LinkIn> in{"in"};
    sc_core::sc_port<LinkOut> out{"out"};
    Scheduler& scheduler;
    std::vector<Cycle> read_in, told_in;
};

TEST(LinkEvent, TellsAModuleThatIsSensitiveToItsPortsOfMessagesAndOfRoom) {
    expect_first_elaboration();
    Scheduler scheduler("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    Link in(scheduler, 1, 4);
    Link out(scheduler, 1, 1);
    Listener listener("listener", scheduler);
    listener.in(in);
    listener.out(out);
    Answer answer;
    Actor others("others", scheduler, [&](Cycle now) {
        if (now == 3 || now == 5) in.send(0, Message(&answer), now == 3 ? 2 : 9);
        Cycle retry = never;
        if (now == 4) out.send(0, Message(&answer), 1);
        if (now == 6) {
            EXPECT_FALSE(out.can_send(0, retry));
        }
        if (now == 20) out.pop(0);
        return now < 20 ? now + 1 : never;
    });
    scheduler.wake(others, 1);
    sc_core::sc_start();
    EXPECT_EQ(listener.read_in, (std::vector<Cycle>{5, 14}));
    ASSERT_FALSE(listener.told_in.empty());
    EXPECT_EQ(listener.told_in.back(), 21u) << "the cycle after room was made";
}

}  // namespace
}  // namespace raycell
