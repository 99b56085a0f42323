#include <vector>

#include "testbench/bench/cases.hpp"

namespace raycell::bench {
namespace {

struct Token {
    Ray ray;
    Answer answer;
    bool answered = false;
    int x = 0;
    int y = 0;
};

}  // namespace

Measured run_bare_tokens(const Traffic& traffic) {
    Scheduler unused("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    Picture picture(traffic.side(), traffic.side());
    const auto environment = traffic.environment(unused, picture);
    std::vector<CellStore> stores(picture.pixels.size());
    std::vector<Token> tokens(stores.size());
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        Token& token = tokens[i];
        token.x = int(i) % traffic.side();
        token.y = int(i) / traffic.side();
        token.ray = primary_ray(environment->context, token.x, token.y);
        SyntheticTraffic::furnish(stores[i], environment->context.scene.frame, token.x, token.y);
    }
    Measured measured;
    const double start = clock_seconds();
    while (!tokens.empty()) {
        for (std::size_t i = 0; i < tokens.size();) {
            Token& token = tokens[i];
            Side side = Side::east;
            if (!token.answered) {
                const CellStore& store =
                    stores[std::size_t(token.y) * std::size_t(traffic.side()) + std::size_t(token.x)];
                const Visit visit = visit_cell(store, token.ray, environment->context);
                if (goes_on(*environment, visit, token.x, token.y)) {
                    side = visit.crossing.side;
                    cross(token.ray, visit.crossing, environment->context.arithmetic);
                } else {
                    token.answer = answer_to(token.ray, Answer::Kind::intensity);
                    token.answered = true;
                }
            }
            if (token.answered) {
                if (token.answer.home_x == token.x && token.answer.home_y == token.y) {
                    token = tokens.back();
                    tokens.pop_back();
                    continue;
                }
                side = way_home(token.answer, token.x, token.y);
            }
            token.x += step_x(side);
            token.y += step_y(side);
            ++measured.hops;
            ++i;
        }
    }
    measured.seconds = clock_seconds() - start;
    return measured;
}

}  // namespace raycell::bench
