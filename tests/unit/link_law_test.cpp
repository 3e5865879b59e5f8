/// Both link laws of the oracle against the rules that they must obey, for pairs with large gaps
/// and rotations.
#include "solver/reference/link_law.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace dss::reference {
namespace {

using Real = long double;
using V = Vector<Real>;

struct Case {
  LinkLaw law;
  int axis;
};

/// The name of a case in the report of a failure.
void PrintTo(const Case& c, std::ostream* out) {
  *out << (c.law == LinkLaw::paper ? "paper" : "material") << " along axis " << c.axis;
}

class EveryLink : public testing::TestWithParam<Case> {
protected:
  static LinkProperties<Real> link(bool is_elastic, bool is_damped) {
    const Body body = fixture::soft_body(GetParam().law);
    const AxisConstants& c = body.axis[std::size_t(GetParam().axis)];
    const Real k = is_elastic, d = is_damped;
    LinkProperties<Real> link;
    link.law = GetParam().law;
    link.axis = GetParam().axis;
    link.arm_i = link.arm_j = V::Unit(link.axis) * Real(body.edge[std::size_t(link.axis)]) / 2;
    link.k_normal = k * c.k_normal;
    link.d_normal = d * c.d_normal;
    for (std::size_t m = 0; m < 3; ++m) {
      link.k_shear[int(m)] = k * c.k_shear[m];
      link.d_shear[int(m)] = d * c.d_shear[m];
      link.k_rot[int(m)] = k * c.k_rot[m];
      link.d_rot[int(m)] = d * c.d_rot[m];
    }
    return link;
  }
  /// A pair of elements anywhere. The rest distance of the elements is the sum of the arms.
  static std::vector<Motion<Real>> random_pair(unsigned seed) {
    const std::vector<double> state =
        fixture::random_state(fixture::make_pair(GetParam().law), seed, 0.05);
    std::vector<Motion<Real>> pair;
    for (const std::size_t e : {0u, 1u}) {
      const std::vector<Real> fields(state.begin() + std::ptrdiff_t(e * field_count),
                                     state.begin() + std::ptrdiff_t((e + 1) * field_count));
      pair.push_back(motion_of(fields));
    }
    return pair;
  }
  static Motion<Real> motion_of(const std::vector<Real>& f) {
    Motion<Real> m;
    m.u = V(f[ux], f[uy], f[uz]);
    m.v = V(f[vx], f[vy], f[vz]);
    m.w = V(f[wx], f[wy], f[wz]);
    m.q = {f[qs], V(f[qx], f[qy], f[qz])};
    // Unit length in Real, not only in double.
    const Real norm = std::sqrt(m.q.q0() * m.q.q0() + m.q.v.squaredNorm());
    m.q = {m.q.q0() / norm - 1, m.q.v / norm};
    m.turned = turn(m.q);
    return m;
  }
};

class PaperLink : public EveryLink {};
class MaterialLink : public EveryLink {};

/// The element turned by `angle` about a global axis through its centre.
Motion<Real> turned_by(Motion<Real> m, int axis, Real angle) {
  const Real ds = std::cos(angle / 2) - 1;
  const V dv = V::Unit(axis) * std::sin(angle / 2);
  m.q = {m.q.s + ds + ds * m.q.s - dv.dot(m.q.v),
         m.q.v + ds * m.q.v + m.q.q0() * dv + dv.cross(m.q.v)};
  m.turned = turn(m.q);
  return m;
}

/// Derivative at 0 by central differences of sixth order.
template <class Function>
Real slope(Function&& f) {
  const Real h = 1e-3L;
  return (45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h);
}

TEST_P(EveryLink, force_and_moments_are_minus_the_slope_of_the_energy) {
  const auto properties = link(true, false);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto pair = random_pair(seed);
    const Reaction<Real> r = reaction(pair[0], pair[1], properties);
    const Real force_scale = r.force.norm(), moment_scale = r.moment_i.norm() + r.moment_j.norm();
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](std::size_t which, bool turns) {
        return slope([&](Real x) {
          std::vector<Motion<Real>> p = pair;
          if (turns)
            p[which] = turned_by(p[which], axis, x);
          else
            p[which].u[axis] += x * 0.1L;
          return elastic_energy(p[0], p[1], properties) * (turns ? 1 : 10);
        });
      };
      EXPECT_NEAR(-moved(0, false), r.force[axis], 1e-12L * force_scale);
      EXPECT_NEAR(-moved(1, false), -r.force[axis], 1e-12L * force_scale);
      EXPECT_NEAR(-moved(0, true), r.moment_i[axis], 1e-12L * moment_scale);
      EXPECT_NEAR(-moved(1, true), r.moment_j[axis], 1e-12L * moment_scale);
    }
  }
}

TEST_P(EveryLink, elastic_part_exchanges_no_net_moment_and_the_material_law_none_at_all) {
  const auto properties = link(true, GetParam().law == LinkLaw::material);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto pair = random_pair(seed);
    const Reaction<Real> r = reaction(pair[0], pair[1], properties);
    const V distance = properties.arm_i + properties.arm_j + pair[1].u - pair[0].u;
    const V lever = distance.cross(r.force);
    const V net = r.moment_i + r.moment_j - lever;
    EXPECT_LE(net.norm(), 1e-17L * (r.moment_i.norm() + r.moment_j.norm() + lever.norm()));
  }
}

TEST_P(PaperLink, damping_does_exchange_a_net_moment_across_an_open_gap) {
  const auto pair = random_pair(3);
  const auto properties = link(false, true);
  const Reaction<Real> r = reaction(pair[0], pair[1], properties);
  const V distance = properties.arm_i + properties.arm_j + pair[1].u - pair[0].u;
  const V expected =
      -gap(pair[0], pair[1], properties).cross(r.force); // a_i + a_j = distance - gap
  const V net = r.moment_i + r.moment_j - distance.cross(r.force);
  EXPECT_LE((net - expected).norm(), 1e-17L * r.moment_i.norm());
  EXPECT_GT(net.norm(), 1e-3L * r.moment_i.norm());
}

TEST_P(MaterialLink, damping_does_no_positive_work) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto pair = random_pair(seed);
    const Reaction<Real> r = reaction(pair[0], pair[1], link(false, true));
    const Real power =
        r.force.dot(pair[0].v - pair[1].v) + r.moment_i.dot(pair[0].w) + r.moment_j.dot(pair[1].w);
    EXPECT_LT(power, 0);
  }
}

TEST_P(MaterialLink, damping_vanishes_when_a_pair_with_an_open_gap_moves_as_one_body) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto pair = random_pair(seed);
    const auto properties = link(false, true);
    const V distance = properties.arm_i + properties.arm_j + pair[1].u - pair[0].u;
    pair[1].w = pair[0].w;
    pair[1].v = pair[0].v + pair[0].w.cross(distance);
    const Reaction<Real> r = reaction(pair[0], pair[1], properties);
    const Real speed = pair[0].v.norm() + pair[1].v.norm();
    EXPECT_LE(r.force.norm(), 1e-17L * properties.d_normal * speed);
    EXPECT_LE(r.moment_i.norm() + r.moment_j.norm(), 1e-17L * properties.d_normal * speed);
  }
}

TEST_P(EveryLink, closed_pair_turned_and_turning_as_one_body_feels_nothing) {
  const auto properties = link(true, true);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto pair = random_pair(seed);
    const V distance = pair[0].rotation() * (properties.arm_i + properties.arm_j);
    pair[1] = pair[0];
    pair[1].u += distance - properties.arm_i - properties.arm_j;
    pair[1].v += pair[0].w.cross(distance);
    const Reaction<Real> r = reaction(pair[0], pair[1], properties);
    EXPECT_LE(r.force.norm(), 1e-17L * properties.k_normal);
    EXPECT_LE(r.moment_i.norm() + r.moment_j.norm(), 1e-17L * properties.k_normal);
    EXPECT_LE(elastic_energy(pair[0], pair[1], properties), 1e-30L * properties.k_normal);
  }
}

TEST_P(EveryLink, small_motion_meets_the_constants_of_its_own_axis) {
  const auto properties = link(true, false);
  const int a = GetParam().axis;
  const bool is_paper = GetParam().law == LinkLaw::paper;
  std::vector<Real> rest(field_count, 0);
  const Motion<Real> i = motion_of(rest);
  for (int axis = 0; axis < 3; ++axis) {
    Motion<Real> pulled = i;
    pulled.u[axis] = 1e-6L;
    const Real k = is_paper || axis == a ? properties.k_normal : properties.k_shear[axis];
    EXPECT_NEAR(reaction(i, pulled, properties).force[axis], k * 1e-6L, 1e-12L * k * 1e-6L);
    const Motion<Real> bent = turned_by(i, axis, 1e-6L);
    Motion<Real> closed = bent; // keeps the face points together
    closed.u = bent.turned * properties.arm_j;
    const Real moment = reaction(i, closed, properties).moment_i[axis];
    const Real k_rot = is_paper ? properties.k_rot[0] : properties.k_rot[axis];
    EXPECT_NEAR(moment, k_rot * 1e-6L, 1e-9L * k_rot * 1e-6L);
  }
}

std::string axis_name(const testing::TestParamInfo<Case>& info) {
  const char* law = info.param.law == LinkLaw::paper ? "paper_" : "material_";
  return law + std::string(1, "xyz"[info.param.axis]);
}

constexpr Case paper_x{LinkLaw::paper, 0}, paper_y{LinkLaw::paper, 1}, paper_z{LinkLaw::paper, 2};
constexpr Case material_x{LinkLaw::material, 0}, material_y{LinkLaw::material, 1},
    material_z{LinkLaw::material, 2};

INSTANTIATE_TEST_SUITE_P(all, EveryLink,
                         testing::Values(paper_x, paper_y, paper_z, material_x, material_y,
                                         material_z),
                         axis_name);
INSTANTIATE_TEST_SUITE_P(all, PaperLink, testing::Values(paper_x, paper_y, paper_z), axis_name);
INSTANTIATE_TEST_SUITE_P(all, MaterialLink, testing::Values(material_x, material_y, material_z),
                         axis_name);

} // namespace
} // namespace dss::reference
