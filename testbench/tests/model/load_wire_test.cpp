// Load messages packed into the bits that they are charged for.
#include "model/machine/load_wire.hpp"

#include <gtest/gtest.h>

#include "../equal_voxels.hpp"
#include "../property.hpp"
#include "layout_tables.hpp"
#include "model/loading/loading.hpp"
#include "model/machine/message.hpp"
#include "model/tracing/tracing.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

/// A scene of random polygons, features and sources, in words.
struct Loaded {
    explicit Loaded(Random& random)
        : scene(shapes::empty_cube(random.whole(3, 40), random.whole(3, 40), random.uniform(4, 90), 64)),
          settings(shapes::settings_for(scene, HitTest(random.whole(0, 4)), Numbers::fixed)) {
        settings.numbers.word_bits = random.whole(8, 32);
        settings.normals = Normals(random.whole(0, 1));
        settings.source_samples = random.whole(1, 12);
        settings.display = random.chance(0.3) ? Display::gouraud : Display::phong;
        const double size = std::min({scene.frame.width, scene.frame.height, int(scene.frame.depth)}) - 1.0;
        const auto corner = [&] {
            return dvec3(random.uniform(0, size), random.uniform(0, size), random.uniform(0, size));
        };
        const auto normal = [&] { return hand_made::random_direction(random.engine()); };
        scene.polygons.push_back(make_triangle(std::uint32_t(random.whole(0, (1 << 20) - 1)), 0,
                                               {corner(), corner(), corner()},
                                               {normal(), normal(), normal()}));
        Material& material = scene.objects[0];
        material.colour = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
        material.specular = random.uniform(0, 1);
        material.transmit = random.uniform(0, 1);
        material.shine = random.chance(0.2) ? 0 : std::exp(random.uniform(-7, 13));
        material.ior = random.uniform(0.5, 3.9);
        material.mirror = random.chance(0.5);
        scene.background = {random.uniform(0, 1), random.uniform(0, 9), 0};
        for (int i = random.whole(0, 5); i > 0; --i)
            scene.sources.push_back(
                {std::exp(random.uniform(-3, 12)) * normal(), dvec3(random.uniform(0, 3))});
        if (random.chance(0.5)) {
            for (Source& source : scene.sources) {
                source.kind = SourceKind(random.whole(0, source_kinds - 1));
                source.axis = normal();
                source.cut_off = random.uniform(0, 1);
                source.falloff = random.chance(0.2) ? 0 : random.uniform(0.1, 100);
                source.edge_u = std::exp(random.uniform(-3, 8)) * normal();
                source.edge_v = std::exp(random.uniform(-3, 8)) * normal();
                source.radius = std::exp(random.uniform(-3, 8));
            }
        }
        scene.frame.depth =
            64 * double(random.whole(1 << 15, (1 << 16) - 1)) * std::ldexp(1.0, random.whole(-22, -15));
    }
    CellScene scene;
    PictureSettings settings;
};

void expect_equal(const NormalField& a, const NormalField& b) {
    EXPECT_EQ(a.base, b.base);
    EXPECT_EQ(a.du, b.du);
    EXPECT_EQ(a.dv, b.dv);
}
void expect_equal(const Surface& a, const Surface& b) {
    EXPECT_EQ(a.polygon, b.polygon);
    EXPECT_EQ(a.plane.n, b.plane.n);
    EXPECT_EQ(a.plane.c, b.plane.c);
    EXPECT_EQ(a.drop, b.drop);
    EXPECT_EQ(a.slack, b.slack);
    EXPECT_EQ(a.last_row, b.last_row);
    expect_equal(a.normal, b.normal);
}
void expect_equal(const std::array<EdgeFunction, 4>& a, const std::array<EdgeFunction, 4>& b, int count) {
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        EXPECT_EQ(a[i].a, b[i].a);
        EXPECT_EQ(a[i].b, b[i].b);
        EXPECT_EQ(a[i].c, b[i].c);
    }
}

void expect_same_voxels(const Span& a, const Span& b, const Loaded& loaded, const Arithmetic& arithmetic) {
    CellStore first;
    CellStore second;
    const double level = loaded.scene.frame.level();
    const bool stored = store_voxel(first, a, loaded.settings, level, arithmetic);
    EXPECT_EQ(store_voxel(second, b, loaded.settings, level, arithmetic), stored);
    if (!stored) return;
    const Voxel& v = first.voxels[0];
    const Voxel& w = second.voxels[0];
    expect_equal_voxels(v, w);
    for (std::uint32_t i = 0; i < v.edge_count; ++i) {
        EXPECT_EQ(first.edges[i].a, second.edges.at(i).a);
        EXPECT_EQ(first.edges[i].b, second.edges.at(i).b);
        EXPECT_EQ(first.edges[i].c, second.edges.at(i).c);
    }
    if (loaded.settings.hit >= HitTest::plane) {
        EXPECT_EQ(v.plane.c, w.plane.c);
    }
}

void expect_rows_packed(const Loaded& loaded, const Trapeze& trapeze, const CornerIntensities& shades,
                        const Arithmetic& arithmetic, const LoadWire& wire, const MessageBits& bits) {
    for (int row = trapeze.rows.first; row <= trapeze.rows.last; ++row) {
        const bool gouraud = loaded.settings.display == Display::gouraud;
        auto span = cut_span(trapeze, row, loaded.scene.frame.depth, loaded.settings.hit, arithmetic,
                             gouraud ? &shades : nullptr);
        if (!span) continue;
        for (;; advance(*span, arithmetic)) {
            const WireBits packed = wire.pack(*span);
            EXPECT_EQ(packed.size(), bits.span + std::min(span->edge_count, bits.span_edges) * bits.edge);
            const Span back = wire.unpack_span(packed);
            EXPECT_EQ(back.polygon, span->polygon);
            EXPECT_EQ(back.x, span->x);
            EXPECT_EQ(back.last, span->last);
            EXPECT_EQ(back.intensity, span->intensity);
            EXPECT_EQ(back.d_intensity, span->d_intensity);
            expect_same_voxels(*span, back, loaded, arithmetic);
            if (testing::Test::HasFailure() || span->x == span->last) break;
        }
    }
}

TEST(LoadWire, SpansTrapezesAndSurfacesUnpackToWhatTheirReceiversUse) {
    int trapezes = 0;
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Loaded loaded(random);
        const Context context(loaded.scene, loaded.settings);
        const Arithmetic& arithmetic = context.arithmetic;
        const LoadWire wire(loaded.settings, arithmetic.formats());
        const MessageBits bits = message_bits(loaded.settings, MachineSettings(), arithmetic.formats());
        Polygon polygon = loaded.scene.polygons[0];
        if (!clip_to_cube(polygon, loaded.scene.frame.cube(), arithmetic)) continue;
        const WireBits packed = wire.pack(polygon);
        EXPECT_EQ(packed.size(), bits.polygon + int(polygon.vertices.size()) * bits.vertex);
        const Polygon back = wire.unpack_polygon(packed);
        EXPECT_EQ(back.id, polygon.id);
        EXPECT_EQ(back.vertices, polygon.vertices);
        EXPECT_EQ(back.slack, polygon.slack);
        EXPECT_EQ(back.plane.n, polygon.plane.n);
        EXPECT_EQ(back.plane.c, polygon.plane.c);
        EXPECT_EQ(back.drop, polygon.drop);
        expect_equal(back.normal, polygon.normal);
        const Frame& frame = loaded.scene.frame;
        for (const Trapeze& trapeze : precompute(back, arithmetic, frame.width, frame.height)) {
            ++trapezes;
            const WireBits shared = wire.pack(static_cast<const Surface&>(trapeze));
            EXPECT_EQ(shared.size(), bits.surface);
            const CornerIntensities shades = shade_corners(trapeze, loaded.scene, arithmetic);
            const WireBits own = wire.pack(trapeze, shades);
            EXPECT_EQ(own.size(), bits.trapeze + trapeze.edge_count * bits.edge);
            CornerIntensities colours{};
            Trapeze received = wire.unpack_trapeze(own, colours);
            static_cast<Surface&>(received) = wire.unpack_surface(shared);
            expect_equal(static_cast<const Surface&>(received), static_cast<const Surface&>(trapeze));
            EXPECT_EQ(received.edge_count, trapeze.edge_count);
            expect_equal(received.edges, trapeze.edges, trapeze.edge_count);
            EXPECT_EQ(received.rows.first, trapeze.rows.first);
            EXPECT_EQ(received.rows.last, trapeze.rows.last);
            EXPECT_EQ(received.columns.first, trapeze.columns.first);
            EXPECT_EQ(received.columns.last, trapeze.columns.last);
            if (loaded.settings.display == Display::gouraud) {
                EXPECT_EQ(colours, shades);
            }
            expect_rows_packed(loaded, received, colours, arithmetic, wire, bits);
        }
        if (testing::Test::HasFailure()) return;
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(trapezes, 200);
    }
}

TEST(LoadWire, TheViewerSourcesAndFeaturesUnpackToTheWordsThatCellsLatch) {
    for (const std::uint64_t seed : property::seeds(1, 500)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Loaded loaded(random);
        const Context context(loaded.scene, loaded.settings);
        const LoadWire wire(loaded.settings, context.arithmetic.formats());
        const MessageBits bits =
            message_bits(loaded.settings, MachineSettings(), context.arithmetic.formats());
        const Frame& frame = loaded.scene.frame;
        const bool kinds = !SourceCounts(context.lights.sources, 1).points();
        const ViewerMessage viewer{context.eye,
                                   random.chance(0.5),
                                   {random.chance(0.5), true},
                                   context.background,
                                   frame.depth_levels,
                                   frame.level(),
                                   context.lights.sources,
                                   kinds,
                                   context.lights.samples,
                                   context.lights.share};
        const WireBits packed = wire.pack(viewer);
        EXPECT_EQ(packed.size(), bits.setup(SourceCounts(viewer.sources, 1)));
        const ViewerMessage back = wire.unpack_viewer(packed);
        EXPECT_EQ(back.eye, viewer.eye);
        EXPECT_EQ(back.at_infinity, viewer.at_infinity);
        EXPECT_EQ(back.beyond, viewer.beyond);
        EXPECT_EQ(back.background, viewer.background);
        EXPECT_EQ(back.depth_levels, viewer.depth_levels);
        EXPECT_EQ(back.level, viewer.level);
        ASSERT_EQ(back.sources.size(), viewer.sources.size());
        for (std::size_t i = 0; i < viewer.sources.size(); ++i) {
            const Source& found = back.sources[i];
            const Source& wanted = viewer.sources[i];
            EXPECT_EQ(found.kind, wanted.kind);
            EXPECT_EQ(found.intensity, wanted.intensity);
            if (wanted.kind != SourceKind::directional) {
                EXPECT_EQ(found.position, wanted.position);
            }
            if (wanted.kind != SourceKind::point && wanted.kind != SourceKind::sphere) {
                EXPECT_EQ(found.axis, wanted.axis);
            }
            if (wanted.kind == SourceKind::spot) {
                EXPECT_EQ(found.cut_off, wanted.cut_off);
                EXPECT_EQ(found.falloff, wanted.falloff);
            }
            if (!is_area(wanted.kind)) continue;
            EXPECT_EQ(found.exponent, wanted.exponent);
            EXPECT_EQ(back.samples, viewer.samples);
            EXPECT_EQ(back.share, viewer.share);
            if (wanted.kind == SourceKind::sphere) {
                EXPECT_EQ(found.radius, wanted.radius);
            } else {
                EXPECT_EQ(found.edge_u, wanted.edge_u);
                EXPECT_EQ(found.edge_v, wanted.edge_v);
            }
        }
        const Material& material = context.objects[0];
        const WireBits features = wire.pack(material);
        EXPECT_EQ(features.size(), bits.features);
        const Material latched = wire.unpack_features(features);
        EXPECT_EQ(latched.colour, material.colour);
        EXPECT_EQ(latched.diffuse, material.diffuse);
        EXPECT_EQ(latched.specular, material.specular);
        EXPECT_EQ(latched.transmit, material.transmit);
        EXPECT_EQ(latched.shine, material.shine);
        EXPECT_EQ(latched.ior, material.ior);
        EXPECT_EQ(latched.mirror, material.mirror);
        EXPECT_EQ(wire.end_of_scene().size(), bits.end_of_scene);
        if (testing::Test::HasFailure()) return;
    }
}

TEST(LoadWire, AtRungDepthWithOneNormalAVoxelASpanIsThePapersAndATrapezeAThirdOfWhatItWas) {
    PictureSettings picture;
    picture.hit = HitTest::depth;
    picture.normals = Normals::voxel;
    const Formats formats(20, Rounding::nearest, {128, 128, 200, 0.2});
    const MessageBits bits = message_bits(picture, MachineSettings(), formats);
    // Before messages followed the rung, with plane, edges, normals and bounds in each.
    constexpr double span_of_all = 1123;
    constexpr double trapeze_of_all = 1361;
    EXPECT_LE(bits.longest_span(), 0.35 * span_of_all);
    EXPECT_LE(bits.longest_trapeze(), 0.35 * trapeze_of_all);
}

TEST(LoadWire, TheDocumentsLayoutsAreThese) {
    PictureSettings picture;
    picture.width = picture.height = 128;
    const Formats formats(20, Rounding::nearest, {128, 128, 200, 0.2});
    PictureSettings papers = picture;
    papers.hit = HitTest::depth;
    papers.normals = Normals::voxel;
    struct Table {
        const char* heading;
        LoadType type;
        const PictureSettings& settings;
        SourceKind kind = SourceKind::point;
    };
    const LoadType kinds = LoadType::viewer_of_kinds;
    for (const Table& table :
         {Table{"## Viewer and sources", LoadType::viewer, picture},
          Table{"## Viewer and a directional source", kinds, picture, SourceKind::directional},
          Table{"## Viewer and a spot", kinds, picture, SourceKind::spot},
          Table{"## Viewer and a rectangle", kinds, picture, SourceKind::rectangle},
          Table{"## Viewer and a sphere", kinds, picture, SourceKind::sphere},
          Table{"## Features", LoadType::features, picture}, Table{"## Polygon", LoadType::polygon, picture},
          Table{"## Surface", LoadType::surface, picture}, Table{"## Trapeze", LoadType::trapeze, picture},
          Table{"## Span", LoadType::span, picture},
          Table{"## Span at rung depth with one normal a voxel", LoadType::span, papers}}) {
        std::vector<std::pair<std::string, int>> fields;
        for (const WireField& field : LoadWire(table.settings, formats).layout(table.type, table.kind))
            fields.emplace_back(field.name, field.bits);
        EXPECT_EQ(layout_table(table.heading), fields) << table.heading;
    }
}

}  // namespace
}  // namespace raycell
