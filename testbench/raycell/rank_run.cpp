#include "testbench/raycell/rank_run.hpp"

#include <algorithm>
#include <functional>

#include "testbench/common/entry.hpp"
#include "testbench/raycell/mpi_transport.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

/// The session. It lives as long as the program, since a failure has to end it when everything else is gone.
std::unique_ptr<RankSession> session;
/// Whether the others are about to end by themselves.
bool others_end = false;

void end_session() {
    session->finish();
    session.reset();
}

/// Called when a message has been printed, before the process ends with `code`.
void end_all(int code) {
    if (!session) return;
    if (!others_end) session->abort(code);
    end_session();
}

Bytes scene_bytes(const CellScene& scene) {
    ByteWriter bytes;
    bytes.put(true);
    bytes.put(scene.frame);
    bytes.put(scene.background);
    bytes.put_all(scene.objects);
    bytes.put_all(scene.sources);
    bytes.put(scene.beyond);
    bytes.put(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons) {
        bytes.put(polygon.id);
        bytes.put(polygon.object);
        bytes.put(polygon.plane);
        bytes.put(polygon.drop);
        bytes.put(polygon.normal);
        bytes.put(polygon.slack);
        bytes.put_all(polygon.vertices);
    }
    return bytes.take();
}

CellScene scene_of(ByteReader& bytes) {
    CellScene scene;
    scene.frame = bytes.get<Frame>();
    scene.background = bytes.get<dvec3>();
    scene.objects = bytes.get_all<Material>();
    scene.sources = bytes.get_all<Source>();
    scene.beyond = bytes.get<std::array<bool, 6>>();
    scene.polygons.resize(bytes.get<std::size_t>());
    for (Polygon& polygon : scene.polygons) {
        polygon.id = bytes.get<std::uint32_t>();
        polygon.object = bytes.get<std::uint32_t>();
        polygon.plane = bytes.get<Plane>();
        polygon.drop = bytes.get<int>();
        polygon.normal = bytes.get<NormalField>();
        polygon.slack = bytes.get<double>();
        polygon.vertices = bytes.get_all<dvec3>();
    }
    return scene;
}

}  // namespace

void add_rank_options(CLI::App& app, RenderOptions& options) {
    app.add_option(
           "--rank-rows", options.rank_rows,
           "with mpirun: the rows at which bands of rows begin, after the first; they are the ranks' in turn")
        ->delimiter(',')
        ->type_name("ROW,...");
}

void check_ranks(const RenderOptions& options) {
    const auto count = std::size_t(launched_ranks().count);
    const std::vector<int>& rows = options.rank_rows;
    if (!rows.empty()) {
        const bool rising =
            std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()) == rows.end();
        if (count == 1) throw UsageError("--rank-rows: expected several ranks, started by mpirun");
        if (rows.size() + 1 < count || !rising || rows.front() < 1 || rows.back() >= options.picture.height) {
            throw UsageError(
                "--rank-rows: expected " + std::to_string(count - 1) + " or more rising numbers from 1 to " +
                std::to_string(options.picture.height - 1) + " for " + std::to_string(count) + " ranks");
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
    if (options.film > 0) refuse("--film");
    if (options.rays) refuse("--rays");
    if (!options.watch_rays.empty()) refuse("--watch-ray");
    if (!options.watch_pixels.empty()) refuse("--watch-pixel");
    if (options.picture.height < launched_ranks().count) {
        throw RanksRefused(std::to_string(launched_ranks().count) + " ranks for " +
                           std::to_string(options.picture.height) +
                           " rows of cells; expected a row for each at least");
    }
}

RankRun::RankRun() {
    session = join_ranks();
    set_failure_hook(end_all);
}

RankRun::~RankRun() = default;

bool RankRun::first() const { return session->rank() == 0; }

CellScene RankRun::share_scene(const std::function<CellScene()>& read) {
    if (first()) {
        try {
            CellScene scene = read();
            session->broadcast(scene_bytes(scene));
            return scene;
        } catch (const std::exception&) {
            ByteWriter failed;
            failed.put(false);
            session->broadcast(failed.take());
            others_end = true;
            throw;
        }
    }
    const Bytes bytes = session->broadcast({});
    ByteReader reader(bytes);
    if (!reader.get<bool>()) {
        others_end = true;
        throw OtherRankFailed();
    }
    return scene_of(reader);
}

RankExchange& RankRun::exchange(const CellScene& scene, const RenderOptions& options) {
    const PictureSettings& settings = options.picture;
    std::vector<int> bands = {0};
    bands.insert(bands.end(), options.rank_rows.begin(), options.rank_rows.end());
    bands.push_back(scene.frame.height);
    if (options.rank_rows.empty()) bands = even_bands(session->count(), scene.frame.height);
    const bool beyond = std::any_of(scene.beyond.begin(), scene.beyond.end(), [](bool b) { return b; });
    const bool exterior =
        beyond && settings.exterior == ExteriorMode::host && settings.stage == RunStage::trace;
    exchange_ = std::make_unique<RankExchange>(*session, std::move(bands), exterior);
    return *exchange_;
}

std::vector<std::string> RankRun::gather_rows(const std::vector<std::string>& mine) {
    ByteWriter bytes;
    for (const std::string& row : mine) bytes.put(row);
    RankReaders readers(*exchange_, session->gather(bytes.take()));
    std::vector<std::string> all;
    if (readers.empty()) return all;
    const int height = exchange_->first_row(exchange_->bands());
    for (int y = 0; y < height; ++y) all.push_back(readers.of_row(y).get_text());
    return all;
}

Json RankRun::report(Machine& machine, std::uint64_t memory_bytes) {
    struct Mine {
        std::uint64_t rows;
        std::uint64_t hops;
        std::uint64_t memory;
        RankExchange::Statistics meetings;
    };
    const Counters& c = machine.environment().meters.counters;
    ByteWriter bytes;
    bytes.put(Mine{exchange_->share().rows().size(), c.load_hops + c.rays.ray_hops + c.rays.return_hops,
                   memory_bytes, exchange_->statistics()});
    std::vector<int> bands;
    for (int band = 0; band < exchange_->bands(); ++band) bands.push_back(exchange_->first_row(band));
    Json json;
    for (const Bytes& theirs : session->gather(bytes.take())) {
        const auto rank = ByteReader(theirs).get<Mine>();
        if (json.empty()) {
            json = {{"count", session->count()},
                    {"meetings", rank.meetings.meetings},
                    {"second_rounds", rank.meetings.second_rounds},
                    {"bands", bands},
                    {"each", Json::array()}};
        }
        json["each"].push_back({{"rows", rank.rows},
                                {"hops", rank.hops},
                                {"bytes_sent", rank.meetings.bytes},
                                {"seconds_waited", rank.meetings.waited},
                                {"peak_memory_bytes", rank.memory}});
    }
    return json;
}

void RankRun::others_are_done() { others_end = true; }

void RankRun::finish() { end_session(); }

}  // namespace raycell
