/// Published problems: extrapolation, and what is said of a figure.
#include "experiments/studies/verification/verification_study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace dss {
namespace {

const std::vector<double> grids = {10, 20, 40, 80};

std::vector<double> figures_of(const std::function<double(double)>& of_spacing) {
  std::vector<double> figures;
  for (const double value : grids) figures.push_back(of_spacing(1 / value));
  return figures;
}

TEST(Extrapolation, FindsLimitAndOrderOfAPower) {
  for (const double order : {1.0, 1.7, 2.0, 4.0}) {
    const Extrapolation found =
        extrapolated(grids, figures_of([&](double h) { return 3 + 5 * std::pow(h, order); }));
    EXPECT_NEAR(found.value, 3, 1e-9) << order;
    EXPECT_NEAR(found.order, order, 1e-6);
    EXPECT_LT(found.uncertainty, 1e-6);
  }
}

TEST(Extrapolation, TakesOrdersBelowOneAsOne) {
  const Extrapolation found =
      extrapolated(grids, figures_of([](double h) { return 3 + 5 * std::sqrt(h); }));
  EXPECT_NEAR(found.order, 0.5, 1e-6);
  const double finest = 3 + 5 * std::sqrt(1 / 80.0), before = 3 + 5 * std::sqrt(1 / 40.0);
  EXPECT_NEAR(found.value, 2 * finest - before, 1e-12);
  const double coarser = 2 * before - (3 + 5 * std::sqrt(1 / 20.0));
  EXPECT_NEAR(found.uncertainty, std::abs(found.value - coarser), 1e-12);
}

TEST(Extrapolation, KeepsTheFinestWhereThereIsNoOrder) {
  const Extrapolation found = extrapolated(grids, {1, 2, 4, 3});
  EXPECT_TRUE(std::isnan(found.order));
  EXPECT_EQ(found.value, 3);
  EXPECT_EQ(found.uncertainty, 2);
}

/// A cantilever whose deflection is known, with a reference that may be wrong.
VerificationStudy study_with(double reference, const std::string& differs) {
  VerificationProblem problem;
  problem.name = "cantilever", problem.title = "A cantilever", problem.source = "closed form";
  problem.scene = "verification/elastica.json", problem.analysis = "static";
  problem.scene = scene_beside("experiments/studies/verification/verification.json", problem.scene);
  problem.model = "planar";
  problem.set = {{"force", "0.01"}};
  problem.refined = "cells", problem.values = {4, 8, 16};
  problem.probes = {"tip=beam,1,0,0"};
  VerifiedFigure figure;
  figure.name = "w", figure.unit = "L", figure.column = "tip.uy", figure.reference = reference;
  figure.differs = differs;
  problem.figures = {figure};
  problem.tolerance = 0.01;
  return {"verification", "Test", "", {problem}};
}

Record row_with(double reference, const std::string& differs = "") {
  const VerificationTables tables =
      verification_tables(study_with(reference, differs), [](const std::string&) {});
  EXPECT_EQ(tables.grids.rows.size(), 3U);
  return tables.figures.rows.at(0);
}

TEST(Verification, SaysWhetherAFigureAgreesConvergesOrDiffers) {
  const double deflection = -0.01 / 3;
  EXPECT_EQ(row_with(deflection).at("status"), "agrees");
  EXPECT_NEAR(std::stod(row_with(deflection).at("model_error")), 0, 1e-3);
  const Record wrong = row_with(1.05 * deflection);
  EXPECT_EQ(wrong.at("status"), "failed");
  EXPECT_NE(wrong.at("reason").find("from the reference"), std::string::npos);
  const Record known = row_with(1.05 * deflection, "a reason");
  EXPECT_EQ(known.at("status"), "differs");
  EXPECT_EQ(known.at("reason"), "a reason");
  EXPECT_EQ(row_with(NAN).at("status"), "converges");
}

TEST(Verification, TakesTheDifferenceOfTwoColumns) {
  VerificationStudy study = study_with(-0.01 / 3, "");
  study.problems.front().figures.front().minus = "tip.ux"; // of second order in the force
  EXPECT_NEAR(number_in(verification_tables(study, [](const std::string&) {}).figures.rows.at(0),
                        "extrapolated"),
              -0.01 / 3, 1e-4);
  study.problems.front().figures.front().minus = "tip.uy";
  EXPECT_EQ(
      number_in(verification_tables(study, [](const std::string&) {}).figures.rows.at(0), "finest"),
      0);
}

TEST(Verification, GoesOnAfterAProblemThatCannotBeSolved) {
  VerificationStudy study = study_with(-0.01 / 3, "");
  study.problems.push_back(study.problems.front());
  study.problems.front().figures.front().column = "tip.none";
  const Table figures = verification_tables(study, [](const std::string&) {}).figures;
  ASSERT_EQ(figures.rows.size(), 2U);
  EXPECT_EQ(figures.rows[0].at("status"), "failed");
  EXPECT_NE(figures.rows[0].at("reason").find("no column \"tip.none\""), std::string::npos);
  EXPECT_EQ(figures.rows[1].at("status"), "agrees");
}

} // namespace
} // namespace dss
