#include "experiments/measure/study_sets.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

using nlohmann::json;

std::vector<std::string> texts(const Sets& sets) {
  std::vector<std::string> texts;
  for (const auto& set : sets) {
    texts.emplace_back();
    for (const Override& item : set) texts.back() += item.key + "=" + item.value + ";";
  }
  return texts;
}

std::string refusal(const json& overrides) {
  try {
    const JsonFile study("study.json", {{"set", overrides}});
    ObjectNode object{Node(study)};
    one_set(object, "set");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Combinations, AreAllOfThemInTheOrderOfKeys) {
  const JsonFile study(
      "study.json",
      {{"set",
        {{"E", 1e7}, {"n", {4, 8}}, {"run.integrator", {"rk4", "midpoint"}}, {"is_held", true}}}});
  ObjectNode object{Node(study)};
  EXPECT_EQ(texts(combinations(object, "set")),
            (std::vector<std::string>{"E=10000000.0;is_held=true;n=4;run.integrator=rk4;",
                                      "E=10000000.0;is_held=true;n=4;run.integrator=midpoint;",
                                      "E=10000000.0;is_held=true;n=8;run.integrator=rk4;",
                                      "E=10000000.0;is_held=true;n=8;run.integrator=midpoint;"}));
}

TEST(Combinations, WithoutTheKeyAreOneSetOfNothing) {
  const JsonFile study("study.json", json::object());
  ObjectNode object{Node(study)};
  EXPECT_EQ(texts(combinations(object, "set")), std::vector<std::string>{""});
  EXPECT_TRUE(one_set(object, "set").empty());
}

TEST(OneSet, RefusesWhatIsNoneWithItsPlace) {
  EXPECT_EQ(refusal({{"n", 4}}), "accepted");
  for (const auto& [overrides, part] : std::vector<std::pair<json, std::string>>{
           {{{"n", {4, 8}}}, "study.json: /set: has several values"},
           {{{"n", json::array()}}, "study.json: /set/n: is empty"},
           {{{"n", {{"m", 1}}}}, "study.json: /set/n: an object of 1 is not a number"},
           {json(3), "study.json: /set: is not an object of overrides"}})
    EXPECT_TRUE(refusal(overrides).starts_with(part)) << refusal(overrides);
}

TEST(SceneBeside, IsAFileByItsEndingElseAShippedName) {
  EXPECT_EQ(scene_beside("/a/study.json", "failures/chain.json"), "/a/failures/chain.json");
  EXPECT_EQ(scene_beside("/a/study.json", "plate_paper"), "plate_paper");
}

} // namespace
} // namespace dss
