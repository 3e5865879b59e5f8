#include "solver/error.hpp"
#include "solver/io/file_set.hpp"
#include "solver/io/state_csv.hpp"
#include "solver/io/vtk/vtu.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "tests/fixtures/problems.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

namespace dss {
namespace {

namespace fs = std::filesystem;

using Output = test::OwnDirectory;

TEST_F(Output, StateCsvHasOneRowAnElementAndTheWholeQuaternion) {
  const Problem problem = fixture::make_plate(4);
  std::vector<double> state(problem.lattice.element_count * field_count);
  state[ux] = 0.1;
  state[qs] = -0.25;
  AtomicFile csv(file("s.csv"));
  write_state_csv(
      csv, problem, state,
      std::vector<ElementStress>(problem.lattice.element_count, ElementStress{{5}, {}}));
  csv.commit();
  const std::string text = read_text(file("s.csv"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 17);
  EXPECT_TRUE(text.starts_with("element,x,y,z,ux,uy,uz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,stress_vm\n"));
  const std::string first = text.substr(text.find('\n') + 1, 200);
  EXPECT_NE(first.find(",0.10000000000000001,0,0,0.75,0,0,0,0,0,0,0,0,0,5\n"), std::string::npos)
      << first;
}

TEST_F(Output, FilesOfASetAreNewOrOldTogether) {
  const auto write = [&](const char* name, const char* text) {
    AtomicFile one(file(name));
    one.write(text);
    one.commit();
  };
  write("a", "old");
  {
    FileSet set;
    for (const char* name : {"a", "b"}) set.open(file(name)).write("new");
  }
  EXPECT_EQ(read_text(file("a")), "old");
  EXPECT_FALSE(std::filesystem::exists(file("b")));
  FileSet set;
  const auto fill = [&] {
    for (const char* name : {"a", "b", "c", "d"}) set.open(file(name)).write("new");
    set.open(file("a")).write("newer");
    set.drop(file("d"));
  };
  fill();
  std::filesystem::create_directories(file("c/full")); // no file can replace it
  EXPECT_THROW(set.commit(), InputError);
  EXPECT_EQ(read_text(file("a")), "old");
  EXPECT_FALSE(std::filesystem::exists(file("b")));
  std::filesystem::remove_all(file("c"));
  fill();
  set.commit();
  EXPECT_EQ(read_text(file("a")), "newer");
  for (const char* name : {"b", "c"}) EXPECT_EQ(read_text(file(name)), "new");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file("")), {}), 3);
}

TEST_F(Output, ASeriesNamesItsFilesAndTimes) {
  const std::vector<Frame> frames = {{"a_0000.vtu", 0}, {"a_0001.vtu", 0.5}};
  write_pvd(file("a.pvd"), frames);
  const std::string text = read_text(file("a.pvd"));
  EXPECT_NE(text.find("<DataSet timestep=\"0.5\" part=\"0\" file=\"a_0001.vtu\"/>"),
            std::string::npos)
      << text;
}

} // namespace
} // namespace dss
