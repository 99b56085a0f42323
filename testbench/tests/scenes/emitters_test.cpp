// Sources from faces whose material emits.
#include "scenes/emitters.hpp"

#include "scene_checks.hpp"
#include "scenes/load_scene.hpp"

namespace raycell {
namespace {

const std::string lamps =
    "newmtl lamp\nKd 1 1 1\nKe 4 2 1\nnewmtl dim\nKd 1 1 1\nKe 0 1 0\nnewmtl wall\nKd 1 1 1\n";

struct Loaded {
    explicit Loaded(const std::string& faces) {
        folder.write("a.mtl", lamps);
        scene = load_scene(folder.write("a.obj", "mtllib a.mtl\n" + faces), {}, diagnostics);
    }
    Folder folder;
    Diagnostics diagnostics;
    Scene scene;
};

TEST(Emitters, AParallelogramIsARectangleAndOtherFacesAreTriangles) {
    const Loaded loaded(
        "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 5 0 0\nv 7 0 0\nv 6 2 0\nv 5 1 0\n"
        "usemtl lamp\nf 1 2 3 4\nusemtl dim\nf 5 6 7\nf 5 6 7 8\nusemtl wall\nf 1 2 3\n");
    const std::vector<LightSource>& sources = loaded.scene.sources;
    ASSERT_EQ(sources.size(), 4u) << all_messages(loaded.diagnostics);
    EXPECT_EQ(sources[0].kind, SourceKind::rectangle);
    EXPECT_EQ(glm::normalize(glm::cross(sources[0].edge_u, sources[0].edge_v)), dvec3(0, 0, 1));
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(sources[i].kind, SourceKind::triangle);
    EXPECT_NE(all_messages(loaded.diagnostics).find("lit by 4 of its own faces"), std::string::npos);
    // Power is area times emission; all together have intensity 1 in their brightest channels.
    double sum = 0;
    for (const LightSource& source : sources)
        sum += std::max({source.colour->x, source.colour->y, source.colour->z});
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(sources[0].colour->y / sources[0].colour->x, 0.5, 1e-12);
    EXPECT_NEAR(sources[0].colour->x / sources[1].colour->y, 4.0 * 2 / 2, 1e-12);
}

TEST(Emitters, OfConcaveFacesAndOfMoreThanThereAreBitsForAreToldOf) {
    const Loaded concave("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nusemtl lamp\nf 1 2 3 4\n");
    EXPECT_EQ(concave.diagnostics.count_of("concave emitting face"), 1u);
    ASSERT_EQ(concave.scene.sources.size(), 1u) << "one at the viewer";
    EXPECT_EQ(concave.scene.sources[0].kind, SourceKind::point);
    std::string many = "usemtl lamp\n";
    for (int i = 1; i <= 70; ++i) {
        const std::string x = std::to_string(200 * i), size = std::to_string(i);
        many += "v " + x + " 0 0\nv " + std::to_string(201 * i) + " 0 0\nv " + x + " " + size +
                " 0\nf -3 -2 -1\n";
    }
    const Loaded crowd(many);
    EXPECT_EQ(crowd.diagnostics.count_of("many emitting faces"), 1u);
    ASSERT_EQ(crowd.scene.sources.size(), max_sources);
    EXPECT_EQ(crowd.scene.sources[0].position.x, 200 * 7) << "the weakest are left out";
}

}  // namespace
}  // namespace raycell
