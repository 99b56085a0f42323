#include "testbench/common/ray_lives.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "cells/cell.hpp"

namespace raycell {

Cycle RayLife::waited_in_all() const { return std::accumulate(waited.begin(), waited.end(), Cycle(0)); }

RayLife* RayLives::find(std::uint64_t id) {
    const auto found = known_.find(id);
    return found == known_.end() ? nullptr : &lives_[found->second];
}

bool RayLives::again(std::uint64_t id) {
    RayLife* life = find(id);
    if (!life) return false;
    life->answering = false;
    life->end = RayLife::End::none;
    life->ended = never;
    ++life->open;
    return true;
}

void RayLives::add(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent) {
    RayLife life;
    const auto above = parent ? known_.find(parent->id) : known_.end();
    life.parent = above == known_.end() ? RayLife::no_parent : above->second;
    life.id = ray.id;
    life.kind = ray.kind;
    life.generation = ray.generation;
    life.depth = life.parent == RayLife::no_parent ? 0 : lives_[life.parent].depth + 1;
    life.x = life.last_x = cell.x();
    life.y = life.last_y = cell.y();
    life.launched = now;
    known_.emplace(ray.id, lives_.size());
    lives_.push_back(life);
}

void RayLives::note(RayLife& life, const Cell& cell, Cycle now, CellEvent event, std::uint32_t detail) {
    using End = RayLife::End;
    switch (event) {
        case CellEvent::test:
            life.last_x = cell.x();
            life.last_y = cell.y();
            if (Visit::Event(detail) == Visit::Event::hit && !is_shadow(life.kind)) life.end = End::hit;
            break;
        case CellEvent::send:
            ++(life.answering ? life.answer_hops : life.ray_hops);
            break;
        case CellEvent::answer:
            life.answering = true;
            if (life.end != End::none) break;
            if (Answer::Kind(detail) == Answer::Kind::lit) life.end = End::lit;
            if (Answer::Kind(detail) == Answer::Kind::blocked) life.end = End::blocked;
            if (Answer::Kind(detail) == Answer::Kind::intensity) life.end = End::background;
            break;
        case CellEvent::deliver: {
            const bool postponed = Answer::Kind(detail) == Answer::Kind::postponed;
            life.postponed += postponed;
            if (--life.open == 0 && !postponed) life.ended = now;
            break;
        }
        case CellEvent::silent:
            life.end = End::silent;
            life.ended = now;
            break;
        case CellEvent::load:
        case CellEvent::accept:
        case CellEvent::postpone:  // reported as the notice, an answer
        case CellEvent::shade:
        case CellEvent::launch:
        case CellEvent::direct:
            break;
    }
}

void RayLives::from_exterior(RayLife& life) {
    life.answering = true;
    life.end = RayLife::End::exterior;
    ++life.answer_hops;
}

void RayLives::silent_outside(RayLife& life, Cycle now) {
    life.end = RayLife::End::exterior;
    life.ended = now;
}

std::vector<std::size_t> RayLives::in_order() const {
    std::vector<std::size_t> order(lives_.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto key = [&](std::size_t i) {
        const RayLife& life = lives_[i];
        return std::make_tuple(life.launched, life.y, life.x, life.id);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    return order;
}

}  // namespace raycell
