// SPDX-License-Identifier: GPL-3.0-or-later
#include "contestants.h"

#include "child_process.h"

namespace eigencrust::bench {
namespace {

namespace fs = std::filesystem;

bool has_open3d(const std::string& python) {
  if (!fs::exists(python)) return false;
  try {
    run_child({python, "-c", "import importlib.util, sys; sys.exit(importlib.util.find_spec('open3d') is None)"});
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

Contestant ours(const std::string& name, const std::vector<std::string>& options, const ContestPrograms& programs,
                const fs::path& cloud, const fs::path& mesh, unsigned threads) {
  Contestant c;
  c.name = name;
  std::vector<std::string> command{programs.eigencrust,    cloud, "-o", mesh, "--quiet", "--threads",
                                   std::to_string(threads)};
  command.insert(command.end(), options.begin(), options.end());
  c.commands = {std::move(command)};
  return c;
}

void add_crusts(const ContestPrograms& programs, const fs::path& cloud, const fs::path& mesh, unsigned threads,
                std::vector<Contestant>& all) {
  for (const char* method : {"spectral-powercrust", "powercrust", "spectral-cocone", "tight-cocone", "robust-cocone"})
    all.push_back(ours(method, {"--method", method}, programs, cloud, mesh, threads));
}

void add_open3d(const ContestPrograms& programs, const fs::path& cloud, const fs::path& mesh, unsigned threads,
                std::vector<Contestant>& all) {
  const bool there = has_open3d(programs.python);
  const fs::path oriented = fs::path(mesh).replace_extension(".oriented.ply");
  const auto add = [&](const char* name, const char* method, const fs::path& from) -> Contestant& {
    Contestant c;
    c.name = name;
    c.peer = c.says_time = true;
    c.commands = {{programs.python, EIGENCRUST_OPEN3D_SCRIPT, method, from, mesh}};
    if (!there) c.missing = "not installed";
    return all.emplace_back(std::move(c));
  };
  add("Open3D Poisson", "poisson", cloud);
  Contestant& with_ours = add("Open3D Poisson, normals by eigencrust orient", "poisson-oriented", oriented);
  with_ours.commands.insert(with_ours.commands.begin(), {programs.eigencrust, "orient", cloud, "-o", oriented,
                                                         "--quiet", "--threads", std::to_string(threads)});
  add("Open3D ball pivoting", "ball-pivoting", cloud);
  add("Open3D alpha shape", "alpha-shape", cloud);
}

void add_cgal(const ContestPrograms& programs, const fs::path& cloud, const fs::path& mesh,
              std::vector<Contestant>& all) {
  for (const auto& [name, method] :
       {std::pair{"CGAL Poisson", "poisson"}, std::pair{"CGAL advancing front", "advancing-front"},
        std::pair{"CGAL scale space", "scale-space"}, std::pair{"CGAL alpha wrap", "alpha-wrap"}}) {
    Contestant c;
    c.name = name;
    c.peer = true;
    c.commands = {{programs.peers, method, cloud, mesh}};
    if (!fs::exists(programs.peers)) c.missing = "not built";
    all.push_back(std::move(c));
  }
}

bool is_installed(const std::string& program) {
  try {
    run_child({"/bin/sh", "-c", "command -v " + program + " > /dev/null"});
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

void add_meshlab(const ContestPrograms& programs, const fs::path& cloud, const fs::path& mesh,
                 std::vector<Contestant>& all) {
  const bool there = fs::exists(programs.python) && is_installed("meshlabserver") && is_installed("xvfb-run");
  for (const auto& [name, method] :
       {std::pair{"MeshLab Poisson", "poisson"}, std::pair{"MeshLab ball pivoting", "ball-pivoting"}}) {
    Contestant c;
    c.name = name;
    c.peer = c.says_time = true;
    c.commands = {{programs.python, EIGENCRUST_MESHLAB_SCRIPT, method, cloud, mesh, programs.eigencrust}};
    if (!there) c.missing = "not installed";
    all.push_back(std::move(c));
  }
}

} // namespace

std::vector<Contestant> contestants(const ContestCase& item, const ContestPrograms& programs, const fs::path& cloud,
                                    const fs::path& mesh, unsigned threads) {
  std::vector<Contestant> all{ours(ourselves, {}, programs, cloud, mesh, threads)};
  all.push_back(ours(faces_only, {"--surface", "delaunay"}, programs, cloud, mesh, threads));
  all.push_back(ours("eigencrust --preset paper", {"--preset", "paper"}, programs, cloud, mesh, threads));
  if (item.crusts) add_crusts(programs, cloud, mesh, threads, all);
  if (!item.peers) return all;
  add_open3d(programs, cloud, mesh, threads, all);
  add_cgal(programs, cloud, mesh, all);
  add_meshlab(programs, cloud, mesh, all);
  return all;
}

} // namespace eigencrust::bench
