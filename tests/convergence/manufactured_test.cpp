/// Manufactured solutions: loads that make every element follow a given motion, so the error of a
/// run is known without a finer run. The method of P. J. Roache, J. Fluids Eng. 124 (2002) 4-10,
/// for every model and method, in the oracle and in the slowest and the fastest variant. The loads
/// come from the oracle's right-hand side, so for the oracle this tests the order in time alone.
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/engine/kernel_set.hpp"

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <string_view>

namespace dss::test {
namespace {

using Vector = Eigen::Vector3d;

/// Each free degree of freedom of a model swings about zero. An element turns about an axis of its
/// own, so its angular velocity is the rate of its rotation vector in every model.
class ManufacturedMotion {
public:
  /// @param problem  its loads are replaced
  ManufacturedMotion(Problem problem, Model model) : problem_(std::move(problem)), model_(model) {
    EXPECT_FALSE(problem_.has_rotating_frame()); // its signals would follow those of loads
    problem_.loads.clear();
    unloaded_ = problem_;
    std::vector<std::uint8_t> clamped(problem_.lattice.element_count);
    for (const Clamp& clamp : problem_.clamps) clamped[clamp.element] = clamp.dofs;
    problem_.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
      add_element(e, problem_.bodies[std::size_t(row.body)], degrees_of(model) & ~clamped[e]);
    });
  }
  ManufacturedMotion(const ManufacturedMotion&) = delete;

  const Problem& problem() const { return problem_; }
  Model model() const { return model_; }

  /// The exact fields of all elements at time t [s].
  State state(double t) const {
    State fields = fixture::rest(problem_);
    for (std::size_t e = 0; e < swings_.size(); ++e) {
      const auto own = std::span(fields).subspan(e * field_count, field_count);
      const Swing& swing = swings_[e];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        own[ux + axis] = swing.shift[int(axis)] * std::sin(swing.phase(t));
        own[vx + axis] = swing.shift[int(axis)] * swing.omega * std::cos(swing.phase(t));
        own[qx + axis] = swing.turn[int(axis)] * std::cos(swing.phase(t)) / 2;
        own[wx + axis] = -swing.turn[int(axis)] * swing.omega * std::sin(swing.phase(t));
      }
      to_quaternion(own); // of half the rotation vector
    }
    return fields;
  }

  /// A row of signals: the wrench on each element is M (y'' - q(y', y, t)).
  std::vector<double> signals(double t) const {
    std::vector<double> row = signals_at(unloaded_, t);
    const State fields = state(t);
    State rates(fields.size());
    Oracle<long double> oracle(unloaded_, *find_method("rk4"), 1, rotation_of(model_));
    oracle.write(fields);
    oracle.derivative(row, rates);
    for (std::size_t e = 0; e < swings_.size(); ++e) {
      const Swing& swing = swings_[e];
      const double* y = &fields[e * field_count];
      const double* rate = &rates[e * field_count];
      const double square = swing.omega * swing.omega;
      const Vector force = swing.mass * (-square * std::sin(swing.phase(t)) * swing.shift -
                                         Vector(rate[vx], rate[vy], rate[vz])),
                   spin = -square * std::cos(swing.phase(t)) * swing.turn -
                          Vector(rate[wx], rate[wy], rate[wz]),
                   torque = inertia(swing, y) * spin;
      for (int c = 0; c < 6; ++c)
        if (swing.loaded & (1 << c)) row.push_back(c < 3 ? force[c] : torque[c - 3]);
    }
    return row;
  }

private:
  struct Swing {
    double mass = 0, omega = 0, start = 0;
    Vector inertia, shift, turn; ///< of the body's axes [kg m^2]; amplitudes [m], [rad]
    int loaded = 0;              ///< bits of Dof
    double phase(double t) const { return omega * t + start; }
  };

  void add_element(std::size_t e, const Body& body, int free) {
    Swing swing;
    swing.mass = problem_.mass(e, body);
    swing.inertia =
        problem_.mass_ratio(e, body) * Vector(body.inertia[0], body.inertia[1], body.inertia[2]);
    swing.omega = 40 + 3 * double(e % 7);
    swing.start = 0.7 * double(e);
    // A tensor of inertia couples the axes, so a moment about a clamped one counts as well.
    constexpr int moments = dof_rx | dof_ry | dof_rz;
    swing.loaded = free & moments ? free | (degrees_of(model_) & moments) : free;
    for (int c = 0; c < 3; ++c) {
      swing.shift[c] = free & (1 << c) ? 2e-3 * std::cos(double(e) + c) : 0;
      swing.turn[c] = free & (8 << c) ? 0.2 * std::cos(1.3 * double(e) + 2 * c) : 0;
    }
    swings_.push_back(swing);
    for (int c = 0; c < 6; ++c) {
      if (!(swing.loaded & (1 << c))) continue;
      Load load;
      load.elements = {e};
      (c < 3 ? load.force : load.torque)[std::size_t(c % 3)] = 1;
      problem_.loads.push_back(load);
    }
  }

  /// About the frame's axes. Models of small rotations leave the body's axes where they are.
  Eigen::Matrix3d inertia(const Swing& swing, const double* y) const {
    const Eigen::Matrix3d own = swing.inertia.asDiagonal();
    if (rotation_of(model_) != Rotation::quaternion) return own;
    const Eigen::Matrix3d a = Eigen::Quaterniond(1 + y[qs], y[qx], y[qy], y[qz]).toRotationMatrix();
    return a * own * a.transpose();
  }

  Problem problem_, unloaded_;
  Model model_;
  std::vector<Swing> swings_;
};

/// A problem with all terms of the model, but for a frame that rotates.
Problem problem_for(Model model) {
  switch (model) {
  case Model::axial:
    return fixture::make_block(11, 1, 1, LinkLaw::material);
  case Model::bending:
    return fixture::make_flat_everything(true);
  case Model::membrane:
  case Model::planar:
    return fixture::pressed(fixture::make_flat_everything());
  case Model::spatial:
    return fixture::of_masses(fixture::pressed(fixture::make_everything()));
  default:
    return fixture::pressed(fixture::make_everything());
  }
}

/// Relative errors of displacements, velocities, orientations and angular velocities; 0 for what a
/// model lacks.
using Errors = std::array<double, 4>;

Errors errors(const State& actual, const State& exact) {
  constexpr int groups[][2] = {{ux, uz}, {vx, vz}, {qs, qz}, {wx, wz}};
  Errors of{};
  for (std::size_t g = 0; g < of.size(); ++g) {
    double difference = 0, scale = 0;
    for (std::size_t at = 0; at < exact.size(); at += field_count)
      for (int f = groups[g][0]; f <= groups[g][1]; ++f) {
        const double x = exact[at + std::size_t(f)], d = actual[at + std::size_t(f)] - x;
        difference += d * d, scale += x * x;
      }
    of[g] = scale > 0 ? std::sqrt(difference / scale) : 0;
  }
  return of;
}

/// A run of a manufactured motion: its rows of signals are found once and serve all variants.
class ManufacturedRun {
public:
  ManufacturedRun(const ManufacturedMotion& motion, const Method& method, double end, long steps)
      : motion_(motion), method_(method), end_(end), steps_(steps) {
    const auto add = [&](double t) {
      const std::vector<double> row = motion.signals(t);
      rows_.insert(rows_.end(), row.begin(), row.end());
    };
    for (long step = 0; step < steps; ++step)
      for (const double node : method.node) add((double(step) + node) * dt());
    add(end);
  }
  double dt() const { return end_ / double(steps_); }

  Errors of_oracle() const {
    Oracle<long double> oracle(motion_.problem(), method_, dt(), rotation_of(motion_.model()));
    oracle.write(motion_.state(0));
    const std::size_t width = signal_count(motion_.problem());
    const auto stopped = oracle.advance(steps_, [&](long step, int stage) {
      const auto row = std::size_t(step) * std::size_t(method_.stages) + std::size_t(stage);
      return std::span(rows_).subspan(row * width, width);
    });
    EXPECT_FALSE(stopped);
    State actual = poisoned(motion_.problem());
    oracle.read(actual);
    return errors(actual, motion_.state(end_));
  }

  Errors of(const Plugin& plugin) const {
    const VariantRun run{plugin, motion_.problem(), method_, motion_.model(), Precision::f64, 1,
                         dt()};
    const auto executor = run.executor();
    executor->write(0, motion_.state(0));
    EXPECT_TRUE(executor->advance(steps_, rows_).is_finite);
    State actual = poisoned(motion_.problem());
    executor->read(0, actual);
    return errors(actual, motion_.state(end_));
  }

private:
  const ManufacturedMotion& motion_;
  const Method& method_;
  double end_;
  long steps_;
  std::vector<double> rows_;
};

void expect_order(const Errors& coarse, const Errors& fine, const Method& method,
                  std::string_view who) {
  const double within = method.order > 5 ? 0.25 : 0.05; // longer steps show the next terms
  for (std::size_t g = 0; g < coarse.size(); ++g)
    if (coarse[g] != 0) {
      EXPECT_NEAR(std::log2(coarse[g] / fine[g]), method.order, within)
          << who << ' ' << method.name << " group " << g;
    }
}

class EveryModel : public testing::TestWithParam<Model> {};

TEST_P(EveryModel, follows_a_manufactured_motion_at_the_order_of_each_method) {
  const ManufacturedMotion motion(problem_for(GetParam()), GetParam());
  constexpr double end = 0.02;
  for (const Method* method : all_methods()) {
    // above rounding; below the first terms
    const long steps = method->order > 5 ? 20 : method->order > 2 ? 40 : 160;
    const ManufacturedRun coarse(motion, *method, end, steps),
        fine(motion, *method, end, 2 * steps);
    expect_order(coarse.of_oracle(), fine.of_oracle(), *method, "oracle");
    if (method->is_implicit() || !is_built(GetParam())) continue;
    for (const char* variant : {"scalar", "auto"})
      expect_order(coarse.of(load_variant(variant)), fine.of(load_variant(variant)), *method,
                   variant);
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryModel, testing::ValuesIn(models),
                         [](const auto& model) { return std::string(name(model.param)); });

} // namespace
} // namespace dss::test
