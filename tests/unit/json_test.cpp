/// The JSON reader alone. Scenes, studies and decompositions have tests of their own.
#include "solver/json/object_node.hpp"
#include "solver/json/parse.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace dss {
namespace {

using nlohmann::json;

/// The error, or "accepted".
std::string error_of(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// The error of a file with this text, without its path.
std::string parse_refusal(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("dss_{}.json", getpid());
  std::ofstream(path) << text;
  const std::string said = error_of([&] { parse_json_file(path.string()); });
  std::filesystem::remove(path);
  return said.starts_with(path.string()) ? said.substr(path.string().size() + 2) : said;
}

TEST(json_file, that_is_broken_is_refused_with_line_and_column) {
  EXPECT_TRUE(parse_refusal("{\n  \"a\" 1}").starts_with("line 2, column 7: not JSON: "));
  EXPECT_TRUE(parse_refusal("[1, 2").starts_with("line 1, column 6: not JSON: "));
  EXPECT_TRUE(parse_refusal("[1e999]").starts_with("not usable JSON, a number is too large"));
  EXPECT_NE(parse_refusal("[\"\xff\x01").find("line 1, column 3: not JSON: "), std::string::npos);
  EXPECT_EQ(parse_refusal("[\"\xff").find('\xff'), std::string::npos);
  EXPECT_EQ(parse_refusal(""), "is empty; give a JSON file");
}

TEST(json_file, with_a_key_twice_is_refused_with_its_place) {
  EXPECT_EQ(parse_refusal(R"({"a": 1, "a": 2})"), "/a: key \"a\" stands twice in one object");
  EXPECT_EQ(parse_refusal(R"([0, {"a": [[], {}, {"x/y": {"b": 1}, "x/y": 1}]}])"),
            "/1/a/2/x~1y: key \"x/y\" stands twice in one object");
  EXPECT_EQ(parse_refusal(R"([{"a": {"b": 1}}, {"a": 1, "b": [{"a": 1}, {"a": 1}]}])"), "accepted");
}

TEST(json_object, tells_all_missing_keys_at_once) {
  const JsonFile file("x.json", {{"b", 1}});
  ObjectNode object{Node(file)};
  EXPECT_EQ(error_of([&] {
              object.must_have({"a", "b", "c"});
            }),
            "x.json: /: lacks the keys \"a\", \"c\"; there are: b");
  EXPECT_EQ(error_of([&] { object.require("bb"); }),
            "x.json: /: lacks the key \"bb\"; there are: b");
}

TEST(json_object, refuses_keys_that_nobody_asked_for) {
  const JsonFile file("x.json", {{"steps", 1}, {"a", {{"s/teps", 2}}}});
  ObjectNode object{Node(file)};
  object.require("steps");
  ObjectNode inner(object.require("a"));
  inner.find("steps");
  EXPECT_EQ(error_of([&] { object.finish(); }), "accepted");
  EXPECT_EQ(error_of([&] { inner.finish(); }),
            "x.json: /a/s~1teps: unknown key; did you mean \"steps\"? known: steps");
}

TEST(json_value, is_read_as_what_it_is_or_refused_with_its_place) {
  const JsonFile file("x.json", {{"n", -3}, {"half", 0.5}, {"text", ""}, {"list", {1, 2}}});
  ObjectNode object{Node(file)};
  EXPECT_EQ(object.require("n").whole(-5), -3);
  EXPECT_EQ(object.require("list").counts(1), (std::vector<int>{1, 2}));
  EXPECT_EQ(object.require("half").positives(), std::vector<double>{0.5});
  EXPECT_EQ(object.whole_or("absent", 1, 7), 7);
  const auto said = [&](const char* key, const std::function<void(const Node&)>& read) {
    return error_of([&] { read(object.require(key)); });
  };
  EXPECT_EQ(said("n", [](const Node& node) { node.non_negative(); }),
            "x.json: /n: -3 is negative; it must be at least 0");
  EXPECT_EQ(said("half", [](const Node& node) { node.whole(0); }),
            "x.json: /half: 0.5 is not a whole number");
  EXPECT_EQ(said("text", [](const Node& node) { node.number(); }),
            "x.json: /text: \"\" is not a number; write a number");
  EXPECT_EQ(said("text", [](const Node& node) { node.name(); }),
            "x.json: /text: \"\" is no name; a name is not empty");
  EXPECT_EQ(said("list", [](const Node& node) { node.counts(2); }),
            "x.json: /list/0: 1 is out of range; it must be from 2 to 2147483647");
  EXPECT_EQ(said("list", [](const Node& node) { node.items(3); }),
            "x.json: /list: an array of 2 is short; give at least 3");
  EXPECT_EQ(said("n", [](const Node& node) { node.items(); }),
            "x.json: /n: -3 is not an array [...]");
}

TEST(json_value, that_names_something_unknown_is_refused_with_the_nearest_name) {
  const JsonFile file("x.json", {{"face", "lower"}});
  const Node face = ObjectNode(Node(file)).require("face");
  EXPECT_EQ(error_of([&] {
              face.known_name("side", {"upper", "lowest"});
            }),
            "x.json: /face: unknown side \"lower\"; did you mean \"lowest\"? known: upper, lowest");
  EXPECT_EQ(face.choice("side", {"upper", "lower"}), 1u);
  EXPECT_EQ(error_of([&] { face.placed([] { throw InputError("no such thing"); }); }),
            "x.json: /face: no such thing");
}

} // namespace
} // namespace dss
