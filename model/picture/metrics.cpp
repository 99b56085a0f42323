#include "model/picture/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace raycell {
namespace {

/// One value per pixel.
struct Channel {
    int width = 0;
    int height = 0;
    std::vector<double> values;
    Channel(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}
    double& at(int x, int y) { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
    double at(int x, int y) const { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

/// Weights from -radius to radius.
using Kernel = std::vector<double>;

Kernel kernel(int radius, const std::function<double(double)>& weight) {
    Kernel all;
    for (int i = -radius; i <= radius; ++i) all.push_back(weight(i));
    return all;
}

double sum_of(const Kernel& kernel) {
    double sum = 0;
    for (const double weight : kernel) sum += weight;
    return sum;
}

Kernel scaled(Kernel kernel, double factor) {
    for (double& weight : kernel) weight *= factor;
    return kernel;
}

/// Along x by one kernel, then along y by the other; beyond the border its pixels go on.
Channel filtered(const Channel& channel, const Kernel& along_x, const Kernel& along_y) {
    Channel middle(channel.width, channel.height);
    const int radius_x = int(along_x.size() / 2);
    const int radius_y = int(along_y.size() / 2);
    for (int y = 0; y < channel.height; ++y) {
        for (int x = 0; x < channel.width; ++x) {
            double sum = 0;
            for (int i = -radius_x; i <= radius_x; ++i)
                sum += along_x[std::size_t(i + radius_x)] *
                       channel.at(std::clamp(x + i, 0, channel.width - 1), y);
            middle.at(x, y) = sum;
        }
    }
    Channel result(channel.width, channel.height);
    for (int y = 0; y < channel.height; ++y) {
        for (int i = -radius_y; i <= radius_y; ++i) {
            const double weight = along_y[std::size_t(i + radius_y)];
            const int from = std::clamp(y + i, 0, channel.height - 1);
            for (int x = 0; x < channel.width; ++x) result.at(x, y) += weight * middle.at(x, from);
        }
    }
    return result;
}

void expect_one_size(const Picture& test, const Picture& truth) {
    if (test.width != truth.width || test.height != truth.height || test.pixels.empty())
        throw std::invalid_argument("pictures of different sizes, or without pixels");
}

dvec3 clamped(const dvec3& colour) { return glm::clamp(colour, dvec3(0), dvec3(1)); }

// ---- FLIP, in the terms of its paper

struct Channels {
    Channel first, second, third;
    Channels(int w, int h) : first(w, h), second(w, h), third(w, h) {}
};

double linear_of(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

dvec3 xyz_of(const dvec3& rgb) {
    return {(10135552.0 * rgb.x + 8788810.0 * rgb.y + 4435075.0 * rgb.z) / 24577794.0,
            (2613072.0 * rgb.x + 8788810.0 * rgb.y + 887015.0 * rgb.z) / 12288897.0,
            (1425312.0 * rgb.x + 8788810.0 * rgb.y + 70074185.0 * rgb.z) / 73733382.0};
}

/// The matrix of xyz_of(), inverted once.
dvec3 rgb_of(const dvec3& xyz) {
    static const glm::dmat3 inverse =
        glm::inverse(glm::dmat3(xyz_of({1, 0, 0}), xyz_of({0, 1, 0}), xyz_of({0, 0, 1})));
    return inverse * xyz;
}

dvec3 white() { return xyz_of({1, 1, 1}); }

/// The opponent space that the eye's contrast sensitivity is known in.
dvec3 ycxcz_of(const dvec3& rgb) {
    const dvec3 r = xyz_of(rgb) / white();
    return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

dvec3 rgb_of_ycxcz(const dvec3& c) {
    const double y = (c.x + 16) / 116;
    return rgb_of(dvec3(y + c.y / 500, y, y - c.z / 200) * white());
}

/// L*a*b*, chroma weakened where it is dark (Hunt effect).
dvec3 hunt_lab_of(const dvec3& rgb) {
    const auto f = [](double t) {
        constexpr double delta = 6.0 / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const dvec3 r = xyz_of(rgb) / white();
    const double l = 116 * f(r.y) - 16;
    return {l, 0.01 * l * 500 * (f(r.x) - f(r.y)), 0.01 * l * 200 * (f(r.y) - f(r.z))};
}

double hyab(const dvec3& a, const dvec3& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

constexpr double pixels_per_degree =
    3840 * 3.14159265358979323846 / 180;  // 0.7 m from a 4K screen 0.7 m wide

/// One of the eye's contrast sensitivities as a sum of Gaussians a·sqrt(pi/b)·exp(-pi²·d²/b), d in degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};

Channel blurred(const Channel& channel, const Sensitivity& s) {
    constexpr double widest = 0.04;  // the largest b of the three
    const double pi = std::acos(-1.0);
    const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    const auto gaussian = [&](double b) {
        return kernel(radius, [&](double i) {
            const double d = i / pixels_per_degree;
            return std::exp(-pi * pi * d * d / b);
        });
    };
    const Kernel g1 = gaussian(s.b1);
    const Kernel g2 = gaussian(s.b2);
    const double w1 = s.a1 * std::sqrt(pi / s.b1);
    const double w2 = s.a2 * std::sqrt(pi / s.b2);
    const double total = w1 * sum_of(g1) * sum_of(g1) + w2 * sum_of(g2) * sum_of(g2);
    Channel sum = filtered(channel, scaled(g1, w1 / total), g1);
    if (s.a2 > 0) {
        const Channel more = filtered(channel, scaled(g2, w2 / total), g2);
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += more.values[i];
    }
    return sum;
}

Channels ycxcz_channels(const Picture& picture) {
    Channels channels(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const dvec3 code = clamped(picture.pixels[i].colour);
        const dvec3 c = ycxcz_of({linear_of(code.x), linear_of(code.y), linear_of(code.z)});
        channels.first.values[i] = c.x;
        channels.second.values[i] = c.y;
        channels.third.values[i] = c.z;
    }
    return channels;
}

/// What the eye makes of the colours, L*a*b*.
std::vector<dvec3> seen_colours(const Channels& channels) {
    const Channel a = blurred(channels.first, {1, 0.0047, 0, 1e-5});
    const Channel rg = blurred(channels.second, {1, 0.0053, 0, 1e-5});
    const Channel by = blurred(channels.third, {34.1, 0.04, 13.5, 0.025});
    std::vector<dvec3> colours;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        colours.push_back(hunt_lab_of(clamped(rgb_of_ycxcz({a.values[i], rg.values[i], by.values[i]}))));
    return colours;
}

/// Strength of edges or points: the length of the vector of both directions' responses.
std::vector<double> features(const Channel& y, bool points) {
    constexpr double width = 0.082;  // degrees
    const double sigma = 0.5 * width * pixels_per_degree;
    const int radius = int(std::ceil(3 * sigma));
    const Kernel g = kernel(radius, [&](double i) { return std::exp(-i * i / (2 * sigma * sigma)); });
    Kernel across = kernel(radius, [&](double i) { return points ? i * i / (sigma * sigma) - 1 : -i; });
    double positive = 0;
    double negative = 0;
    for (std::size_t i = 0; i < across.size(); ++i) {
        across[i] *= g[i];
        (across[i] < 0 ? negative : positive) += across[i];
    }
    // Positive weights sum up to 1, negative ones to -1.
    for (double& weight : across) weight /= (weight < 0 ? -negative : positive) * sum_of(g);
    const Channel in_x = filtered(y, across, g);
    const Channel in_y = filtered(y, g, across);
    std::vector<double> strength;
    for (std::size_t i = 0; i < in_x.values.size(); ++i)
        strength.push_back(std::hypot(in_x.values[i], in_y.values[i]));
    return strength;
}

/// The colour errors are spread over [0, 1], the largest, green to blue, at 1.
double spread(double error) {
    constexpr double exponent = 0.7;
    constexpr double cut = 0.4;
    constexpr double at_cut = 0.95;
    static const double most = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), exponent);
    const double e = std::pow(error, exponent);
    if (e < cut * most) return at_cut / (cut * most) * e;
    return at_cut + (e - cut * most) / (most - cut * most) * (1 - at_cut);
}

Channel brightness(const Channels& channels) {
    Channel y = channels.first;
    for (double& value : y.values) value = (value + 16) / 116;
    return y;
}

}  // namespace

double ssim(const Picture& test, const Picture& truth) {
    expect_one_size(test, truth);
    constexpr double c1 = 0.01 * 0.01;
    constexpr double c2 = 0.03 * 0.03;
    constexpr double sigma = 1.5;
    const auto luma = [](const Picture& picture) {
        Channel channel(picture.width, picture.height);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            channel.values[i] = glm::dot(clamped(picture.pixels[i].colour), dvec3(0.299, 0.587, 0.114));
        return channel;
    };
    Kernel window = kernel(5, [](double i) { return std::exp(-i * i / (2 * sigma * sigma)); });
    window = scaled(window, 1 / sum_of(window));
    const auto mean_of_products = [&](const Channel& a, const Channel& b) {
        Channel product = a;
        for (std::size_t i = 0; i < a.values.size(); ++i) product.values[i] *= b.values[i];
        return filtered(product, window, window);
    };
    const Channel a = luma(test);
    const Channel b = luma(truth);
    const Channel mean_a = filtered(a, window, window);
    const Channel mean_b = filtered(b, window, window);
    const Channel aa = mean_of_products(a, a);
    const Channel bb = mean_of_products(b, b);
    const Channel ab = mean_of_products(a, b);
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double ma = mean_a.values[i];
        const double mb = mean_b.values[i];
        const double variances = aa.values[i] - ma * ma + bb.values[i] - mb * mb;
        sum += (2 * ma * mb + c1) * (2 * (ab.values[i] - ma * mb) + c2) /
               ((ma * ma + mb * mb + c1) * (variances + c2));
    }
    return sum / double(a.values.size());
}

double flip(const Picture& test, const Picture& truth) {
    expect_one_size(test, truth);
    const Channels a = ycxcz_channels(test);
    const Channels b = ycxcz_channels(truth);
    const std::vector<dvec3> colours_a = seen_colours(a);
    const std::vector<dvec3> colours_b = seen_colours(b);
    const Channel y_a = brightness(a);
    const Channel y_b = brightness(b);
    const std::vector<double> edges_a = features(y_a, false);
    const std::vector<double> edges_b = features(y_b, false);
    const std::vector<double> points_a = features(y_a, true);
    const std::vector<double> points_b = features(y_b, true);
    double sum = 0;
    for (std::size_t i = 0; i < colours_a.size(); ++i) {
        const double colour = spread(hyab(colours_a[i], colours_b[i]));
        const double feature =
            std::max(std::abs(edges_a[i] - edges_b[i]), std::abs(points_a[i] - points_b[i]));
        sum += std::pow(colour, 1 - std::sqrt(feature / std::sqrt(2.0)));
    }
    return sum / double(colours_a.size());
}

double relative_mse(const Picture& test, const Picture& truth) {
    expect_one_size(test, truth);
    constexpr double least = 0.01;  // keeps black pixels from counting for all
    double sum = 0;
    for (std::size_t i = 0; i < test.pixels.size(); ++i) {
        const dvec3 right = truth.pixels[i].colour;
        const dvec3 error = test.pixels[i].colour - right;
        const dvec3 relative = error * error / (right * right + dvec3(least));
        sum += relative.x + relative.y + relative.z;
    }
    return sum / (3 * double(test.pixels.size()));
}

}  // namespace raycell
