#include "testbench/raycell/rank_run.hpp"

#include <algorithm>
#include <functional>

#include "testbench/raycell/entry.hpp"
#include "testbench/raycell/mpi_transport.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

/// The session that a failure has to end; there is one at most.
RankSession* live = nullptr;
bool failure_is_known = false;

/// Called when a message has been printed, before the process ends with `code`.
void end_all(int code) {
    if (!live) return;
    if (!failure_is_known) live->abort(code);
    live->finish();
    live = nullptr;
}

Bytes scene_bytes(const CellScene& scene) {
    ByteWriter bytes;
    bytes.put(true);
    bytes.put(scene.frame);
    bytes.put(scene.background);
    bytes.put_all(scene.objects);
    bytes.put_all(scene.sources);
    bytes.put(scene.beyond);
    return bytes.take();
}

/// All that cells, distributors and links look at; polygons are geometry's, which is rank 0's.
CellScene scene_of(ByteReader& bytes) {
    CellScene scene;
    scene.frame = bytes.get<Frame>();
    scene.background = bytes.get<dvec3>();
    scene.objects = bytes.get_all<Material>();
    scene.sources = bytes.get_all<Source>();
    scene.beyond = bytes.get<std::array<bool, 6>>();
    return scene;
}

}  // namespace

void add_rank_options(CLI::App& app, RenderOptions& options) {
    app.add_option(
           "--rank-rows", options.rank_rows,
           "with mpirun: the rows at which the ranks after the first begin; else all have equally many")
        ->delimiter(',')
        ->type_name("ROW,...");
}

void check_ranks(const RenderOptions& options) {
    const auto count = std::size_t(launched_ranks().count);
    const std::vector<int>& rows = options.rank_rows;
    if (!rows.empty()) {
        const bool rising =
            std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()) == rows.end();
        if (rows.size() + 1 != count || !rising || rows.front() < 1 ||
            rows.back() >= options.picture.height) {
            throw UsageError("--rank-rows: expected " + std::to_string(count - 1) +
                             " rising numbers from 1 to " + std::to_string(options.picture.height - 1) +
                             " for " + std::to_string(count) + " ranks");
        }
    }
    if (count == 1) return;
    const auto refuse = [](const std::string& what) {
        throw RanksRefused(what + " can't be had of several ranks; expected one process, without mpirun");
    };
    if (options.engine == Engine::untimed) refuse("--engine untimed");
    if (!options.probes.cells.empty()) refuse("--probe");
    if (options.probes.on_deadlock) refuse("--vcd-on-deadlock");
    if (!options.golden.empty()) refuse("--golden");
    if (!options.save_array.empty()) refuse("--save-array");
    if (!options.load_array.empty()) refuse("--load-array");
    if (!options.watch_rays.empty()) refuse("--watch-ray");
    if (!options.watch_pixels.empty()) refuse("--watch-pixel");
    if (options.picture.height < launched_ranks().count) {
        throw RanksRefused(std::to_string(launched_ranks().count) + " ranks for " +
                           std::to_string(options.picture.height) +
                           " rows of cells; expected a row for each at least");
    }
}

RankRun::RankRun() : session_(join_ranks()) {
    live = session_.get();
    failure_is_known = false;
    set_failure_hook(end_all);
}

RankRun::~RankRun() = default;

bool RankRun::first() const { return session_->rank() == 0; }

CellScene RankRun::share_scene(const std::function<CellScene()>& read) {
    if (first()) {
        try {
            CellScene scene = read();
            session_->broadcast(scene_bytes(scene));
            return scene;
        } catch (const std::exception&) {
            ByteWriter failed;
            failed.put(false);
            session_->broadcast(failed.take());
            failure_is_known = true;
            session_.release();  // end_all() has use for it yet
            throw;
        }
    }
    const Bytes bytes = session_->broadcast({});
    ByteReader reader(bytes);
    if (!reader.get<bool>()) {
        failure_is_known = true;
        session_.release();
        throw OtherRankFailed();
    }
    return scene_of(reader);
}

RankExchange& RankRun::exchange(const CellScene& scene, const RenderOptions& options) {
    const PictureSettings& settings = options.picture;
    std::vector<int> rows = even_rank_rows(session_->count(), scene.frame.height);
    std::copy(options.rank_rows.begin(), options.rank_rows.end(), rows.begin() + 1);
    const bool beyond = std::any_of(scene.beyond.begin(), scene.beyond.end(), [](bool b) { return b; });
    const bool exterior =
        beyond && settings.exterior == ExteriorMode::host && settings.stage == RunStage::trace;
    exchange_ = std::make_unique<RankExchange>(*session_, std::move(rows), exterior);
    return *exchange_;
}

std::string RankRun::gather_text(const std::string& mine) {
    ByteWriter bytes;
    bytes.put(mine);
    std::string all;
    for (const Bytes& theirs : session_->gather(bytes.take())) all += ByteReader(theirs).get_text();
    return all;
}

Json RankRun::report(Machine& machine, std::uint64_t memory_bytes) {
    struct Mine {
        int first;
        int end;
        std::uint64_t hops;
        std::uint64_t memory;
        RankExchange::Statistics meetings;
    };
    const Counters& c = machine.environment().counters;
    const ArrayShare& share = exchange_->share();
    ByteWriter bytes;
    bytes.put(Mine{share.first, share.end, c.load_hops + c.rays.ray_hops + c.rays.return_hops, memory_bytes,
                   exchange_->statistics()});
    Json json;
    for (const Bytes& theirs : session_->gather(bytes.take())) {
        const auto rank = ByteReader(theirs).get<Mine>();
        if (json.empty()) {
            json = {{"count", session_->count()},
                    {"meetings", rank.meetings.meetings},
                    {"second_rounds", rank.meetings.second_rounds},
                    {"each", Json::array()}};
        }
        json["each"].push_back({{"first_row", rank.first},
                                {"rows", rank.end - rank.first},
                                {"hops", rank.hops},
                                {"bytes_sent", rank.meetings.bytes},
                                {"seconds_waited", rank.meetings.waited},
                                {"peak_memory_bytes", rank.memory}});
    }
    return json;
}

void RankRun::finish() {
    live = nullptr;
    session_->finish();
}

}  // namespace raycell
