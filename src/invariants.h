// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What each chapter owes the next. Checked between the chapters of debug builds.
#pragma once

#include <string>

#include <eigencrust/stages.h>

#include "evidence/evidence.h"
#include "settle/settle.h"
#include "tetrahedra/scene.h"

namespace eigencrust {

// The first fault found, as a sentence for developers; empty where all is as it must be.

/// Samples are distinct and stand for their rows, tetrahedra are in canonical order, positive, and neighbours of their
/// neighbours, stars are complete, poles and measures there for each sample.
std::string fault_in(const Scene& scene, const PointCloud& cloud);
/// Each tetrahedron has what is known of it, those at the cube are known, and what was named stands.
std::string fault_in(const Evidence& evidence, const Scene& scene);
/// Rows are compressed, increasing and symmetric, without loops; weights are numbers.
std::string fault_in(const SignedGraph& graph);
/// What is known keeps its label.
std::string fault_in(const PoleLabels& poles, const Scene& scene, const Evidence& evidence);
/// Each tetrahedron has a side that its value agrees with; with the minimum cut no single one would cost less turned.
std::string fault_in(const Settled& settled, const Scene& scene, const Options& options);
/// Each tetrahedron has a side that its value agrees with; where a manifold was asked for, each star is a disc.
std::string fault_in(const TetrahedronLabels& labels, const Scene& scene, const Options& options);
/// Vertices are samples, triangles faces of tetrahedra inside; where nothing was cut away every edge has two triangles.
std::string fault_in(const Surface& surface, const Scene& scene, const TetrahedronLabels& labels,
                     const Options& options);

/// Says so and aborts if there is a fault.
void stop_at(const std::string& fault, const char* file, int line);

} // namespace eigencrust

#ifdef NDEBUG
#define EIGENCRUST_SOUND(...) static_cast<void>(0)
#else
#define EIGENCRUST_SOUND(...) ::eigencrust::stop_at(::eigencrust::fault_in(__VA_ARGS__), __FILE__, __LINE__)
#endif
