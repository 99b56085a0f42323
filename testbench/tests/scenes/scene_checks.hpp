// Shared by the tests of the readers.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

#include "model/geometry/scene.hpp"
#include "model/shading/shading.hpp"
#include "scenes/load_scene.hpp"

namespace raycell {

inline bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool unit_length(const dvec3& v) { return finite(v) && std::abs(glm::length(v) - 1) < 1e-9; }

inline void expect_sound(const PolygonPrimitive& polygon) {
    ASSERT_GE(polygon.vertices.size(), 3u);
    for (const dvec3& v : polygon.vertices) ASSERT_TRUE(finite(v));
    ASSERT_TRUE(polygon.normals.empty() || polygon.normals.size() == polygon.vertices.size());
    for (const dvec3& n : polygon.normals) ASSERT_TRUE(unit_length(n));
}
inline void expect_sound(const SpherePrimitive& sphere) {
    ASSERT_TRUE(finite(sphere.centre) && std::isfinite(sphere.radius) && sphere.radius > 0);
}
inline void expect_sound(const ConePrimitive& cone) {
    ASSERT_TRUE(finite(cone.base) && finite(cone.apex) && cone.base != cone.apex);
    ASSERT_TRUE(std::isfinite(cone.base_radius) && cone.base_radius >= 0);
    ASSERT_TRUE(std::isfinite(cone.apex_radius) && cone.apex_radius >= 0);
    ASSERT_GT(cone.base_radius + cone.apex_radius, 0);
}

/// Expects every promise of model/geometry/scene.hpp.
inline void expect_sound(const Scene& scene) {
    ASSERT_TRUE(finite(scene.background));
    ASSERT_LE(scene.sources.size(), max_sources);
    for (const LightSource& source : scene.sources) {
        ASSERT_TRUE(finite(source.position));
        ASSERT_TRUE(!source.colour || finite(*source.colour));
    }
    for (const Material& m : scene.materials) {
        ASSERT_TRUE(finite(m.colour) && glm::all(glm::greaterThanEqual(m.colour, dvec3(0))));
        ASSERT_TRUE(m.diffuse >= 0 && m.diffuse <= 1 && m.specular >= 0 && m.specular <= 1);
        ASSERT_TRUE(m.transmit >= 0 && m.transmit <= 1 && m.ior > 0 && std::isfinite(m.ior));
        ASSERT_TRUE(m.shine >= 0 && std::isfinite(m.shine));
    }
    for (const Primitive& primitive : scene.primitives) {
        ASSERT_LT(primitive.material, scene.materials.size());
        std::visit([](const auto& shape) { expect_sound(shape); }, primitive.shape);
    }
    if (!scene.view) return;
    const View& v = *scene.view;
    ASSERT_TRUE(finite(v.from) && finite(v.at) && finite(v.up) && v.from != v.at);
    ASSERT_TRUE(v.angle > 0 && v.angle < 180 && v.hither >= 0 && std::isfinite(v.hither));
    ASSERT_TRUE(v.width >= 1 && v.height >= 1);
}

struct Counts {
    std::size_t polygons = 0, spheres = 0, cones = 0;
};
inline Counts count(const Scene& scene) {
    Counts counts;
    for (const Primitive& p : scene.primitives) {
        if (std::holds_alternative<PolygonPrimitive>(p.shape)) ++counts.polygons;
        if (std::holds_alternative<SpherePrimitive>(p.shape)) ++counts.spheres;
        if (std::holds_alternative<ConePrimitive>(p.shape)) ++counts.cones;
    }
    return counts;
}

inline const PolygonPrimitive& polygon(const Scene& scene, std::size_t i) {
    return std::get<PolygonPrimitive>(scene.primitives.at(i).shape);
}

inline std::string all_messages(const Diagnostics& diagnostics) {
    std::string out;
    for (const std::string& message : diagnostics.messages()) out += message + "\n";
    return out;
}

/// A fresh folder for a test's files, removed at the end.
class Folder {
  public:
    Folder() {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        std::string name =
            "raycell_" + std::to_string(getpid()) + "_" + info->test_suite_name() + "_" + info->name();
        std::replace(name.begin(), name.end(), '/', '_');  // in names of tests with parameters
        path_ = std::filesystem::temp_directory_path() / name;
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Folder of the scene data beside the project; it may be missing.
inline std::filesystem::path shared_scenes() {
    return std::filesystem::path(RAYCELL_SOURCE_DIR) / ".." / "shared" / "scenes";
}

}  // namespace raycell
