#include "pipeline/activity.hpp"

#include <algorithm>

namespace raycell {
namespace {

/// The events counted so far.
Activity::Bucket events(const Counters& c) {
    Activity::Bucket all;
    all.hops = c.rays.ray_hops + c.rays.return_hops;
    all.load_hops = c.load_hops;
    all.pixels_done = c.pixels_done;
    all.cells_loaded = c.cells_loaded;
    all.postponed = c.rays_destroyed;
    return all;
}

}  // namespace

Activity::Bucket& Activity::Bucket::operator+=(const Bucket& other) {
    rays_in_flight += other.rays_in_flight;
    answers_in_flight += other.answers_in_flight;
    slots_used += other.slots_used;
    hops += other.hops;
    load_hops += other.load_hops;
    pixels_done += other.pixels_done;
    cells_loaded += other.cells_loaded;
    postponed += other.postponed;
    return *this;
}

Cycle Activity::cycles_of(std::size_t index) const {
    const Cycle from = start + Cycle(index) * bucket_cycles;
    return std::min(end, from + bucket_cycles) - from;
}

void ActivityRecorder::begin(Cycle start, const Counters& counters, bool levels) {
    levels_ = levels;
    activity_ = Activity();
    activity_.start = start;
    activity_.end = start;
    current_ = Activity::Bucket();
    before_ = events(counters);
    seen_ = start;
    bucket_end_ = start + 1;
}

void ActivityRecorder::take_events(const Counters& counters) {
    const Activity::Bucket now = events(counters);
    current_.hops = now.hops - before_.hops;
    current_.load_hops = now.load_hops - before_.load_hops;
    current_.pixels_done = now.pixels_done - before_.pixels_done;
    current_.cells_loaded = now.cells_loaded - before_.cells_loaded;
    current_.postponed = now.postponed - before_.postponed;
    before_ = now;
}

void ActivityRecorder::close_bucket(const Counters& counters) {
    std::vector<Activity::Bucket>& buckets = activity_.buckets;
    if (buckets.size() == most_buckets) {
        // Joins pairs of buckets. The current bucket becomes the first half of one of twice the width.
        for (std::size_t i = 0; i < most_buckets / 2; ++i) {
            buckets[i] = buckets[2 * i];
            buckets[i] += buckets[2 * i + 1];
        }
        buckets.resize(most_buckets / 2);
        activity_.bucket_cycles *= 2;
        bucket_end_ = activity_.start + Cycle(buckets.size() + 1) * activity_.bucket_cycles;
        return;
    }
    if (levels_) extend(bucket_end_, counters);
    take_events(counters);
    buckets.push_back(current_);
    current_ = Activity::Bucket();
    bucket_end_ += activity_.bucket_cycles;
}

void ActivityRecorder::finish(Cycle end, const Counters& counters) {
    observe(end, counters);
    if (end > activity_.start + Cycle(activity_.buckets.size()) * activity_.bucket_cycles) {
        take_events(counters);
        activity_.buckets.push_back(current_);
    }
    activity_.end = end;
}

}  // namespace raycell
