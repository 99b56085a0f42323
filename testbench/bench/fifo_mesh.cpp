// A mesh of cells that only forward messages, over SystemC's own channel.
#include <array>
#include <ostream>
#include <systemc>
#include <vector>

#include "testbench/bench/cases.hpp"

namespace raycell::bench {

/// What the fifos carry.
struct Packet {
    Message message;
};
static std::ostream& operator<<(std::ostream& out, const Packet& packet) {
    return out << int(packet.message.kind);
}

namespace {

using Fifo = sc_core::sc_fifo<Packet>;

/// One fifo per side and class, as Networks::half has them.
class FifoCell : public sc_core::sc_module {
  public:
    using In = sc_core::sc_port<sc_core::sc_fifo_in_if<Packet>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;
    using Out = sc_core::sc_port<sc_core::sc_fifo_out_if<Packet>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;
    static constexpr std::size_t classes = 3;

    SC_HAS_PROCESS(FifoCell);
    FifoCell(sc_core::sc_module_name name, Environment& environment, int x, int y)
        : sc_module(name), environment_(environment), x_(x), y_(y) {
        SyntheticTraffic::furnish(store_, environment.context.scene.frame, x, y);
        RayPacket* own = environment.pools.rays.take();
        own->ray = primary_ray(environment.context, x, y);
        held_.back() = Message(own);
    }
    std::array<In, side_count * classes> in;
    std::array<Out, side_count * classes> out;

  private:
    void end_of_elaboration() override {
        SC_METHOD(run);
        for (std::size_t i = 0; i < in.size(); ++i) {
            if (in[i].size() > 0) sensitive << in[i]->data_written_event();
            if (out[i].size() > 0) sensitive << out[i]->data_read_event();
        }
    }
    void run() {
        if (held_.back().kind != Message::Kind::none) move(held_.back());
        for (std::size_t i = 0; i < in.size(); ++i) {
            Message& held = held_[i];
            Packet packet;
            while (in[i].size() > 0 && (held.kind != Message::Kind::none || in[i]->nb_read(packet))) {
                if (held.kind == Message::Kind::none) held = packet.message;
                if (!move(held)) break;
            }
        }
    }
    /// Sends the message if it can, and then empties `held`. False: it stays.
    bool move(Message& held) {
        if (held.kind == Message::Kind::ray && !forward(*held.ray)) {
            if (held.ray->stage != RayPacket::Stage::untested) return false;
            Answer* answer = environment_.pools.answers.take();
            *answer = answer_to(held.ray->ray, Answer::Kind::intensity);
            environment_.pools.rays.give_back(held.ray);
            held = Message(answer);
        }
        if (held.kind == Message::Kind::answer && !send_home(*held.answer)) return false;
        held = Message();
        return true;
    }
    /// False: the ray waits for its output (`decided`) or ends in this cell (still `untested`).
    bool forward(RayPacket& packet) {
        if (packet.stage == RayPacket::Stage::untested)
            packet.visit = visit_cell(store_, packet.ray, environment_.context);
        if (!goes_on(environment_, packet.visit, x_, y_)) return false;
        packet.stage = RayPacket::Stage::decided;
        const Side side = packet.visit.crossing.side;
        Out& port = out[std::size_t(side) * classes + std::size_t(environment_.classes.ray(packet.ray))];
        if (port->num_free() == 0) return false;
        cross(packet.ray, packet.visit.crossing, environment_.context.arithmetic);
        packet.stage = RayPacket::Stage::untested;
        ++environment_.meters.counters.rays.ray_hops;
        port->nb_write({Message(&packet)});
        return true;
    }
    bool send_home(Answer& answer) {
        if (answer.home_x == x_ && answer.home_y == y_) {
            environment_.picture.at(x_, y_).colour = answer.colour;
            ++environment_.meters.counters.pixels_done;
            environment_.pools.answers.give_back(&answer);
            return true;
        }
        Out& port =
            out[std::size_t(way_home(answer, x_, y_)) * classes + std::size_t(environment_.classes.answer)];
        if (port->num_free() == 0) return false;
        ++environment_.meters.counters.rays.return_hops;
        port->nb_write({Message(&answer)});
        return true;
    }

    Environment& environment_;
    CellStore store_;
    int x_;
    int y_;
    std::array<Message, side_count * classes + 1> held_;  ///< the last one: the own ray
};

struct Mesh {
    explicit Mesh(const Traffic& traffic)
        : picture(traffic.side(), traffic.side()), environment(traffic.environment(scheduler, picture)) {
        const int side = traffic.side();
        for (int i = 0; i < side * side; ++i) {
            cells.push_back(std::make_unique<FifoCell>(("cell_" + std::to_string(i)).c_str(), *environment,
                                                       i % side, i / side));
        }
        for (int i = 0; i < side * side; ++i) {
            for (int way = 0; way < side_count; ++way) connect(i % side, i / side, Side(way));
        }
    }
    void connect(int x, int y, Side way) {
        const int to_x = x + step_x(way);
        const int to_y = y + step_y(way);
        if (to_x < 0 || to_y < 0 || to_x >= picture.width || to_y >= picture.height) return;
        for (int index = 0; index < int(FifoCell::classes); ++index) {
            if (!environment->classes.used(index, int(way) % 2 == 0, way)) continue;
            fifos.push_back(std::make_unique<Fifo>(environment->machine.buffer_depth));
            const auto at = [&](int cx, int cy) {
                return std::size_t(cy) * std::size_t(picture.width) + std::size_t(cx);
            };
            const auto port = [&](Side side) {
                return std::size_t(side) * FifoCell::classes + std::size_t(index);
            };
            cells[at(x, y)]->out[port(way)].bind(*fifos.back());
            cells[at(to_x, to_y)]->in[port(opposite(way))].bind(*fifos.back());
        }
    }
    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    Picture picture;
    std::unique_ptr<Environment> environment;
    std::vector<std::unique_ptr<FifoCell>> cells;
    std::vector<std::unique_ptr<Fifo>> fifos;
};

}  // namespace

Measured run_sc_fifo(const Traffic& traffic) {
    Measured measured;
    const double before = resident_bytes();
    const double start = clock_seconds();
    Mesh& mesh = *new Mesh(traffic);  // never destroyed: SystemC takes ports down in quadratic time
    const double cells = double(mesh.cells.size());
    measured.bytes_per_cell = (resident_bytes() - before) / cells;
    measured.build_seconds = clock_seconds() - start;
    const double traced = clock_seconds();
    sc_core::sc_start();
    measured.seconds = clock_seconds() - traced;
    const Counters& counters = mesh.environment->meters.counters;
    if (counters.pixels_done != mesh.cells.size()) throw std::logic_error("a ray was not answered");
    measured.hops = counters.rays.ray_hops + counters.rays.return_hops;
    return measured;
}

}  // namespace raycell::bench
