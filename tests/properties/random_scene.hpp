#pragma once
/// Random small scenes, as JSON: bodies, laws, links, clamps, loads, motions. RapidCheck makes each
/// number and each choice simpler on its own, so that a scene that fails becomes a simple one.
#include <rapidcheck.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace dss::test {

using Json = nlohmann::json;

/// A scene, and how it is run.
struct RandomScene {
  Json scene;
  std::string method, model;
  double share = 0.1; ///< of the longest stable step
  int steps = 1;
  int threads = 1, tile = 0; ///< of the run that is compared with another
};

inline void showValue(const RandomScene& random, std::ostream& out) {
  out << "method " << random.method << ", model " << random.model << ", " << random.share
      << " of the longest step, " << random.steps << " steps, " << random.threads
      << " threads, tiles of " << random.tile << ", scene\n"
      << random.scene.dump(2);
}

/// 0 to count - 1, equally likely however small the other numbers of a sample are.
inline rc::Gen<int> below(int count) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, count));
}
/// One of some values, the simplest first.
template <class T>
rc::Gen<T> one_of(std::vector<T> values) {
  const int count = int(values.size());
  return rc::gen::map(below(count),
                      [values = std::move(values)](int n) { return values[std::size_t(n)]; });
}
/// A number from -most to most, in hundredths of it; zero is the simplest.
inline rc::Gen<double> within(double most) {
  return rc::gen::map(below(201),
                      [most](int n) { return most / 100 * (n % 2 == 1 ? -(n + 1) / 2 : n / 2); });
}
inline rc::Gen<Json> vector_within(double most) {
  return rc::gen::map(rc::gen::container<std::vector<double>>(3, within(most)),
                      [](const std::vector<double>& x) { return Json(x); });
}

/// Constants of any law. Half of their terms are zero, since these have other kernels.
inline rc::Gen<Json> random_constants() {
  const auto or_zero = [](double value) { return one_of<double>({0, value}); };
  return rc::gen::apply(
      [](int law, double d, double kt, double dt, double nu, double damping) {
        if (law == 0)
          return Json{{"law", "paper"}, {"k", 1e4},  {"d", d},         {"kt", kt},
                      {"dt", dt},       {"mass", 1}, {"inertia", 2e-3}};
        Json constants{{"E", 2e7}, {"rho", 1000}, {"damping_ratio", damping}};
        constants["law"] = law == 1 ? "material" : "solid";
        if (law == 2)
          constants["nu"] = nu;
        else
          constants["G"] = 1e7 / (1 + nu);
        return constants;
      },
      below(3), or_zero(3), or_zero(12), or_zero(4e-3), or_zero(0.2), or_zero(0.03));
}

/// A box, or a box with holes.
inline rc::Gen<Json> random_geometry() {
  return rc::gen::apply(
      [](int nx, int ny, int nz, double filling, int seed) {
        const Json size{nx, ny, nz};
        return filling == 1
                   ? Json{{"box", size}}
                   : Json{{"porous", {{"size", size}, {"filling", filling}, {"seed", seed}}}};
      },
      rc::gen::inRange(1, 35), rc::gen::inRange(1, 7), rc::gen::inRange(1, 5),
      one_of<double>({1, 0.9, 0.6}), rc::gen::inRange(1, 1000));
}

inline rc::Gen<Json> random_load() {
  const Json harmonic{{"harmonic", {{"amplitude", 2}, {"frequency", 40}, {"phase", 0.3}}}};
  return rc::gen::apply(
      [](const std::string& face, Json force, Json torque, Json signal) {
        return Json{{"body", "first"},           {"select", {{"face", face}}},
                    {"force", std::move(force)}, {"torque", std::move(torque)},
                    {"share", "total"},          {"signal", std::move(signal)}};
      },
      one_of<std::string>({"+x", "-x", "+y", "-y", "+z", "-z"}), vector_within(20),
      vector_within(1), one_of<Json>({1, {{"ramp", {{"to", 1}, {"duration", 1e-3}}}}, harmonic}));
}

/// What holds or moves the first body. Clamps need elements that start at rest, so it is one of
/// both, or nothing.
inline rc::Gen<Json> random_start() {
  return rc::gen::apply(
      [](int kind, Json velocity, Json spin, Json pulled) {
        const auto clamp = [](const char* face, Json dofs) {
          return Json{{"clamps", Json::array({{{"body", "first"},
                                               {"select", {{"face", face}}},
                                               {"dofs", std::move(dofs)}}})}};
        };
        if (kind == 0) return Json::object();
        if (kind == 1) return clamp("-y", "all");
        if (kind == 2) return clamp("+x", Json::array({"ux", "uz"}));
        return Json{{"initial", Json::array({{{"body", "first"},
                                              {"velocity", std::move(velocity)},
                                              {"angular_velocity", std::move(spin)},
                                              {"rigid", true}},
                                             {{"body", "first"},
                                              {"select", {{"face", "+x"}}},
                                              {"displacement", std::move(pulled)}}})}};
      },
      below(4), vector_within(0.5), vector_within(3), vector_within(1e-3));
}

/// A second body whose first face is linked to the last face of the first one, which is a box.
inline void add_second(Json& scene, int length, Json constants) {
  Json size = scene["bodies"][0]["geometry"]["box"];
  size[0] = length;
  scene["bodies"].push_back({{"name", "second"},
                             {"geometry", {{"box", std::move(size)}}},
                             {"element", scene["bodies"][0]["element"]},
                             {"constants", std::move(constants)}});
  scene["extra_links"] = Json::array({{{"from", {{"body", "first"}, {"face", "+x"}}},
                                       {"to", {{"body", "second"}, {"face", "-x"}}}}});
}

inline rc::Gen<Json> random_json() {
  return rc::gen::apply(
      [](Json geometry, Json element, Json constants, Json start, std::vector<Json> loads,
         Json gravity, int second, Json constants_of_second, bool is_tied, int turning) {
        Json scene{{"scene", "random"},
                   {"title", "A random scene"},
                   {"bodies", Json::array({{{"name", "first"},
                                            {"geometry", std::move(geometry)},
                                            {"element", std::move(element)},
                                            {"constants", std::move(constants)}}})},
                   {"gravity", std::move(gravity)},
                   {"run", {{"dt", 1e-6}, {"steps", 1}}}};
        scene.update(start);
        if (!loads.empty()) scene["loads"] = std::move(loads);
        if (is_tied)
          scene["stabilization"] = {{"k", 20}, {"d", 0.2}, {"k_rot", 0.01}, {"d_rot", 1e-4}};
        if (turning == 0)
          scene["base_rotation"] = {{"x", {{"harmonic", {{"amplitude", 0.7}, {"frequency", 40}}}}},
                                    {"z", {{"rate", 30}}}};
        if (second > 0 && scene["bodies"][0]["geometry"].contains("box"))
          add_second(scene, second, std::move(constants_of_second));
        return scene;
      },
      random_geometry(), one_of<Json>({0.1, Json::array({0.1, 0.08, 0.12})}), random_constants(),
      random_start(), rc::gen::scale(0.03, rc::gen::container<std::vector<Json>>(random_load())),
      vector_within(10), rc::gen::map(below(10), [](int n) { return std::max(0, n - 4); }),
      random_constants(), rc::gen::arbitrary<bool>(), below(5));
}

} // namespace dss::test

namespace rc {

template <>
struct Arbitrary<dss::test::RandomScene> {
  static Gen<dss::test::RandomScene> arbitrary() {
    using namespace dss::test;
    return gen::apply(
        [](Json scene, std::string method, std::string model, double share, int steps, int threads,
           int tile) {
          return RandomScene{
              std::move(scene), std::move(method), std::move(model), share, steps, threads, tile};
        },
        random_json(),
        one_of<std::string>({"rk4", "velocity_verlet", "smoothed_verlet", "midpoint",
                             "symplectic_euler", "dopri5", "verner8", "rkc2"}),
        one_of<std::string>({"spatial", "small", "linear"}), one_of<double>({0.1, 0.5}),
        gen::inRange(1, 30), gen::inRange(1, 6), one_of<int>({0, 1, 2, 3, 40}));
  }
};

} // namespace rc
