// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What each result says in the report. Run::stage() finds these functions by the type of the result.
#pragma once

#include <vector>

#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

namespace eigencrust {

class Run;
struct CentringCounts;
struct HandleCounts;
struct PieceCounts;
struct PassedSheetsReport;
struct RecoveryCounts;
struct SampleMeasures;
struct SamplesApart;
struct TurnedOver;
struct UnsupportedTriangles;
struct LinesOfSight;
struct Contradictions;
struct KnownBeforehand;
struct MinimumLabels;
struct Overlaps;
struct PointResults;
struct EdgeFlipCounts;
struct UncrossCounts;

void describe(const Samples& samples, Run& run);
void describe(const SampleMeasures& measures, Run& run);
void describe(const Tetrahedralization& tetrahedralization, Run& run);
void describe(const Poles& poles, Run& run);
void describe(const KnownBeforehand& known, Run& run);
void describe(const LinesOfSight& sight, Run& run);
void describe(const Partition& partition, Run& run);
void describe(const PoleLabels& labels, Run& run);
void describe(const MinimumLabels& labels, Run& run);
void describe(const Overlaps& overlaps, Run& run);
void describe(const ManifoldCounts& counts, Run& run);
void describe(const PieceCounts& counts, Run& run);
void describe(const HandleCounts& counts, Run& run);
void describe(const PassedSheetsReport& sheets, Run& run);
void describe(const RecoveryCounts& counts, Run& run);
void describe(const Contradictions& contradictions, Run& run);
void describe(const std::vector<DroppedComponent>& dropped, Run& run);
void describe(const SamplesApart& samples, Run& run);
void describe(const UnsupportedTriangles& unsupported, Run& run);
void describe(const TurnedOver& turned, Run& run);
void describe(const PointResults& results, Run& run);
void describe(const UncrossCounts& counts, Run& run);
void describe(const EdgeFlipCounts& counts, Run& run);
void describe(const MeshSummary& mesh, Run& run);

} // namespace eigencrust
