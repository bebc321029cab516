// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit_cases.h"

#include <array>
#include <cstdio>
#include <iostream>

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>

#include "child_process.h"

namespace eigencrust::bench {
namespace {

constexpr std::array depths{6, 7, 8, 9};

double both_ways(const FitFigures& f) { return (f.error.to_truth + f.error.from_truth) / 2; }

FitFigures measured(const TriangleMesh& mesh, const Truth& truth, const FitScene& scene, unsigned threads) {
  FitFigures figures{surface_error(mesh, *truth.mesh, threads), -1};
  figures.error.to_truth /= scene.spacing;
  figures.error.from_truth /= scene.spacing;
  if (!scene.on_edge.empty())
    figures.edges = summarize(distances_to_surface(scene.on_edge, mesh, threads)).mean / scene.spacing;
  return figures;
}

Result reconstructed(const FitScene& scene, SurfaceKind kind, unsigned threads) {
  Options options;
  options.surface = kind;
  options.threads = threads;
  return reconstruct(scene.cloud, options);
}

/// Sets outcome.poisson and depth where Open3D can be run.
void run_poisson(const Truth& truth, const FitScene& scene, const FitBenchOptions& options, FitOutcome& outcome) {
  const std::string name = outcome.shape + "-" + std::to_string(outcome.sigma);
  const std::filesystem::path cloud = options.work / (name + ".ply"), prefix = options.work / (name + "-poisson");
  WriteOptions as_they_are;
  as_they_are.coordinates = CoordinateType::float64;
  write_point_cloud(cloud, scene.cloud, as_they_are);
  std::vector<std::string> command{options.python, EIGENCRUST_POISSON_SCRIPT, cloud.string(), prefix.string()};
  for (const int depth : depths) command.push_back(std::to_string(depth));
  try {
    run_child(command);
  } catch (const Error& error) {
    std::cerr << "no Poisson surface: " << error.what() << "\n";
    return;
  }
  for (const int depth : depths) {
    const TriangleMesh mesh = read_mesh(prefix.string() + "-" + std::to_string(depth) + ".ply");
    const FitFigures figures = measured(mesh, truth, scene, options.threads);
    if (outcome.poisson && both_ways(*outcome.poisson) <= both_ways(figures)) continue;
    outcome.poisson = figures;
    outcome.depth = depth;
  }
}

std::string number(double value, int digits) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", digits, value);
  return buffer.data();
}

std::string cells(const FitFigures& f) {
  return number(f.error.to_truth, 3) + " / " + number(f.error.from_truth, 3) + ", " + number(f.error.normals, 1) + "°" +
         (f.edges < 0 ? "" : ", edges " + number(f.edges, 2));
}

} // namespace

FitOutcome run_fit_case(const FitShape& shape, double sigma, const FitBenchOptions& options) {
  const Truth truth = truth_of(shape, options.data);
  const FitScene scene = fit_scene(truth, options.samples, sigma, options.seed);
  FitOutcome outcome;
  outcome.shape = shape.name;
  outcome.sigma = sigma;
  outcome.true_genus = truth.genus;
  outcome.samples =
      measured(reconstructed(scene, SurfaceKind::samples, options.threads).mesh, truth, scene, options.threads);
  const Result result = reconstructed(scene, SurfaceKind::automatic, options.threads);
  outcome.fitted = measured(result.mesh, truth, scene, options.threads);
  outcome.crossings = result.report.mesh.self_intersections;
  outcome.genus = result.report.mesh.genus;
  outcome.components = result.report.mesh.components;
  write_mesh(options.work / (shape.name + "-" + std::to_string(sigma) + "-fitted.ply"), result.mesh);
  run_poisson(truth, scene, options, outcome);
  return outcome;
}

std::string to_markdown(const std::vector<FitOutcome>& outcomes) {
  std::string table =
      "| shape | σ | samples | fitted | screened Poisson, best depth | distance, fitted / Poisson | normals, the same "
      "| "
      "crossings | pieces, genus (true) |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const FitOutcome& o : outcomes) {
    table += "| " + o.shape + " | " + number(o.sigma, 2) + " | " + cells(o.samples) + " | " + cells(o.fitted) + " | ";
    if (o.poisson)
      table += cells(*o.poisson) + " (" + std::to_string(o.depth) + ") | " +
               number(both_ways(o.fitted) / both_ways(*o.poisson), 2) + " | " +
               number(o.fitted.error.normals / o.poisson->error.normals, 2) + " | ";
    else
      table += "no Open3D | | | ";
    table += std::to_string(o.crossings) + " | " + std::to_string(o.components) + ", " + std::to_string(o.genus) +
             " (" + std::to_string(o.true_genus) + ") |\n";
  }
  return table;
}

} // namespace eigencrust::bench
