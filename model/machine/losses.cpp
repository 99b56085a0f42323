#include "model/machine/losses.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace raycell {
namespace {

double brightest(const dvec3& c) { return std::max({c.x, c.y, c.z}); }

double largest_feature(const Material& m) {
    return std::max({brightest(m.colour), m.diffuse, m.specular, m.transmit});
}

/// Both the index of refraction and its reciprocal must fit.
bool index_fits(const Material& m, const Formats& f) {
    return m.transmit == 0 || (m.ior <= f.ior.most() && 1 / m.ior <= f.normal.most());
}

bool has_single_normal(const Polygon& polygon, const Formats& formats) {
    dvec3 centre{0, 0, 0};
    for (const dvec3& v : polygon.vertices) centre += v / double(polygon.vertices.size());
    const dvec2 middle = project(centre, polygon.drop);
    bool single = false;
    const double most = scale_by(1, formats.normal.integer_bits() - 1);
    const NormalField near{polygon.normal.at(middle), polygon.normal.du, polygon.normal.dv};
    fill_words(near, near.base, most, least_normal(formats.normal), &single);
    return single;
}

std::string number(double x) {
    std::ostringstream text;
    text << x;
    return text.str();
}

}  // namespace

Losses losses_of(const Context& context) {
    Losses losses;
    losses.polygons = context.scene.polygons.size();
    if (context.arithmetic.exact()) return losses;
    const Formats& f = context.arithmetic.formats();
    for (const Material& m : context.scene.objects) {
        losses.features += largest_feature(m) > f.feature.most();
        losses.indices += !index_fits(m, f);
    }
    losses.lights += brightest(context.scene.background) > f.intensity.most();
    for (const Source& source : context.scene.sources) {
        losses.lights += brightest(source.intensity) > f.intensity.most();
    }
    losses.drift = context.depth * f.unit.step() / 2;
    for (const Polygon& polygon : context.scene.polygons) {
        losses.single_normals += context.settings.normals == Normals::linear && has_single_normal(polygon, f);
    }
    return losses;
}

std::vector<std::string> loss_warnings(const Losses& losses, const Context& context) {
    std::vector<std::string> warnings;
    if (context.arithmetic.exact()) return warnings;
    const Formats& f = context.arithmetic.formats();
    const auto warn = [&](const std::string& text) {
        warnings.push_back("words of " + std::to_string(f.word_bits) + " bits: " + text);
    };
    if (losses.features > 0) {
        double most = 0;
        for (const Material& m : context.scene.objects) most = std::max(most, largest_feature(m));
        warn("a colour or coefficient of " + number(most) + " is held as " + number(f.feature.most()));
    }
    if (losses.lights > 0) {
        double most = brightest(context.scene.background);
        for (const Source& source : context.scene.sources) most = std::max(most, brightest(source.intensity));
        warn("a light of " + number(most) + " is held as " + number(f.intensity.most()));
    }
    if (losses.indices > 0) {
        warn("an index of refraction outside " + number(1 / f.normal.most()) + " to " + number(f.ior.most()) +
             " is held as the nearest of these");
    }
    if (losses.drift > 0.1) {
        warn("rays may be off by " + number(losses.drift) + " cells at the back of a cube " +
             number(context.depth) + " cells deep");
    }
    if (losses.single_normals > 0) {
        warn(std::to_string(losses.single_normals) + " of " + std::to_string(losses.polygons) +
             " polygons are so small that each has one normal; expected longer words (--word-bits)");
    }
    return warnings;
}

std::uint64_t saturated_pixels(const Picture& picture, const Context& context) {
    if (context.arithmetic.exact()) return 0;
    const double most = context.arithmetic.formats().intensity.most();
    return std::uint64_t(std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                       [&](const Pixel& pixel) { return brightest(pixel.colour) >= most; }));
}

}  // namespace raycell
