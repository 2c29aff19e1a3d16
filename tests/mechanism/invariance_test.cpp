// SPDX-License-Identifier: MIT
// The motion of a mechanism that is turned, moved, scaled, mirrored, or written down in another order is the
// same motion turned, moved, scaled, mirrored; for every mechanism of the catalogue.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

constexpr int kRows = 73;

/// v → scale · R v + shift, y reversed before where mirrored.
struct Similarity {
  double angle = 0, scale = 1;
  Vector2d shift = Vector2d::Zero();
  bool mirrored = false;

  Vector2d direction(const Vector2d& v) const {
    const double y = mirrored ? -v.y() : v.y();
    return {std::cos(angle) * v.x() - std::sin(angle) * y, std::sin(angle) * v.x() + std::cos(angle) * y};
  }
  Vector2d point(const Vector2d& v) const { return scale * direction(v) + shift; }
  double sign() const { return mirrored ? -1 : 1; }
};

Mechanism transformed(Mechanism mechanism, const Similarity& by) {
  for (Point& point : mechanism.points) {
    if (point.fixed) point.position = by.point(point.position);
  }
  for (SketchPoint& mark : mechanism.sketch) mark.position = by.point(mark.position);
  for (Body& body : mechanism.bodies) {
    for (BodyPoint& p : body.points) p.local = by.scale * Vector2d(p.local.x(), by.sign() * p.local.y());
  }
  for (Slide& slide : mechanism.slides) {
    slide.offset *= by.scale * by.sign();
    slide.angle *= by.sign();
  }
  for (Drive& drive : mechanism.drives) {
    const double factor = drive.slide ? by.scale : by.sign();
    drive.start = factor * drive.start + (drive.slide ? 0 : by.angle);
    drive.speed *= factor;
    drive.law_scale *= factor;
  }
  return mechanism;
}

/// Links in the reverse order and with other names.
Mechanism reordered(Mechanism mechanism) {
  const std::size_t last = mechanism.bodies.size() - 1;
  std::reverse(mechanism.bodies.begin(), mechanism.bodies.end());
  for (Slide& slide : mechanism.slides) {
    if (slide.carrier) slide.carrier = last - *slide.carrier;
    if (slide.of) slide.of = last - *slide.of;
  }
  for (Drive& drive : mechanism.drives) {
    if (!drive.slide) drive.body = last - drive.body;
  }
  for (Body& body : mechanism.bodies) body.name = "z_" + body.name;
  for (Point& point : mechanism.points) point.name = "a_" + point.name;
  return mechanism;
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms"))
    all.push_back(entry.path().stem().string());
  std::sort(all.begin(), all.end());
  return all;
}

class Invariance : public ::testing::TestWithParam<std::string> {
 protected:
  Mechanism mechanism_ = read_mechanism(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/" + GetParam() + ".toml");
  Motion motion_ = solve_motion(mechanism_, kRows);

  /// Positions agree to what `condition` roundings leave, and rates to that of their larger size.
  void expect_similar(const Motion& other, const Similarity& by, double condition) {
    const double size = mechanism_.largest_length();
    double speed = 0;
    for (const Configuration& here : motion_.configurations) {
      for (const PointState& p : here.points) {
        if (std::isfinite(p.velocity.x())) speed = std::max(speed, p.velocity.norm());
      }
    }
    for (std::size_t row = 0; row < motion_.times.size(); ++row) {
      const Configuration& a = motion_.configurations[row];
      const Configuration& b = other.configurations[row];
      ASSERT_EQ(a.status, b.status) << row;
      if (a.status != Status::ok) continue;
      for (std::size_t p = 0; p < a.points.size(); ++p) {
        const Vector2d place = (b.points[p].position - by.point(a.points[p].position)) / by.scale;
        const Vector2d rate = b.points[p].velocity / by.scale - by.direction(a.points[p].velocity);
        ASSERT_LT(place.norm(), condition * 1e-15 * size) << row << " " << mechanism_.points[p].name;
        ASSERT_LT(rate.norm(), condition * 1e-13 * speed) << row << " " << mechanism_.points[p].name;
      }
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Catalogue, Invariance, ::testing::ValuesIn(names()), [](const auto& tested) {
  std::string name = tested.param;
  name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
  return name;
});

/// Roundings are multiplied by up to about 300 in the parallelogram half a degree from its change point, and
/// by less elsewhere; a dozen of them add up.
constexpr double kCondition = 1e4;

TEST_P(Invariance, UnderScaling) {
  for (const double scale : {1e-6, 1e6}) {
    Similarity by;
    by.scale = scale;
    expect_similar(solve_motion(transformed(mechanism_, by), kRows), by, kCondition);
  }
}

TEST_P(Invariance, UnderRotationAndTranslation) {
  for (const double angle : {0.3, -1.5707963267948966, 3.0}) {
    Similarity by;
    by.angle = angle;
    by.shift = mechanism_.largest_length() * Vector2d(3, -2);
    expect_similar(solve_motion(transformed(mechanism_, by), kRows), by, kCondition);
  }
}

TEST_P(Invariance, UnderMirroring) {
  Similarity by;
  by.mirrored = true;
  expect_similar(solve_motion(transformed(mechanism_, by), kRows), by, kCondition);
}

TEST_P(Invariance, UnderAnotherOrderAndOtherNames) {
  expect_similar(solve_motion(reordered(mechanism_), kRows), {}, kCondition);
}

}  // namespace
}  // namespace oblique::mechanism
