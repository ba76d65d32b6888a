#include "common/body/segments.h"

#include <cstddef>

namespace footing::body {
namespace {

struct Row {
  std::string_view name;
  double length_mm, mass_percent, centre_percent, sagittal_percent, transverse_percent,
      longitudinal_percent;
};

using Table = std::array<Row, kSegmentCount>;

// de Leva 1996, Table 4. Upper trunk: CERV-XIPH; head: VERT-CERV; shank: KJC-AJC; hand: WJC-MET3.
constexpr double kFemaleStatureMm = 1735, kFemaleTrunkMm = 497.9;  // MIDS-MIDH.
constexpr Table kFemale{{
    // name            length mass   centre sagittal transverse longitudinal
    // -               mm     %      %      %        %          %
    {"head", 243.7, 6.68, 48.41, 27.1, 29.5, 26.1},
    {"upper trunk", 228.0, 15.45, 50.50, 46.6, 31.4, 44.9},
    {"middle trunk", 205.3, 14.65, 45.12, 43.3, 35.4, 41.5},
    {"lower trunk", 181.5, 12.47, 49.20, 43.3, 40.2, 44.4},
    {"upper arm", 275.1, 2.55, 57.54, 27.8, 26.0, 14.8},
    {"forearm", 264.3, 1.38, 45.59, 26.1, 25.7, 9.4},
    {"hand", 78.0, 0.56, 74.74, 53.1, 45.4, 33.5},
    {"thigh", 368.5, 14.78, 36.12, 36.9, 36.4, 16.2},
    {"shank", 438.6, 4.81, 43.52, 26.7, 26.3, 9.2},
    {"foot", 228.3, 1.29, 40.14, 29.9, 27.9, 13.9},
}};
constexpr double kMaleStatureMm = 1741, kMaleTrunkMm = 515.5;
constexpr Table kMale{{
    {"head", 242.9, 6.94, 50.02, 30.3, 31.5, 26.1},
    {"upper trunk", 242.1, 15.96, 50.66, 50.5, 32.0, 46.5},
    {"middle trunk", 215.5, 16.33, 45.02, 48.2, 38.3, 46.8},
    {"lower trunk", 145.7, 11.17, 61.15, 61.5, 55.1, 58.7},
    {"upper arm", 281.7, 2.71, 57.72, 28.5, 26.9, 15.8},
    {"forearm", 268.9, 1.62, 45.74, 27.6, 26.5, 12.1},
    {"hand", 86.2, 0.61, 79.00, 62.8, 51.3, 40.1},
    {"thigh", 422.2, 14.16, 40.95, 32.9, 32.9, 14.9},
    {"shank", 440.3, 4.33, 43.95, 25.1, 24.6, 10.2},
    {"foot", 258.1, 1.37, 44.15, 25.7, 24.5, 12.4},
}};

constexpr const Row& At(const Table& table, Segment segment) {
  return table[static_cast<std::size_t>(segment)];
}

/// Masses of the table sum to 99.99 or 100.01: they are made to sum to one.
double MassSum(const Table& table) {
  double sum = 0;
  for (int i = 0; i < kSegmentCount; ++i) {
    const bool paired = static_cast<Segment>(i) >= Segment::kUpperArm;
    sum += (paired ? 2 : 1) * table[static_cast<std::size_t>(i)].mass_percent;
  }
  return sum;
}

SegmentParameters FromRow(const Table& table, double stature_mm, Segment segment) {
  const Row& row = At(table, segment);
  return {row.name,
          row.length_mm / stature_mm,
          row.mass_percent / MassSum(table),
          row.centre_percent / 100,
          row.sagittal_percent / 100,
          row.transverse_percent / 100,
          row.longitudinal_percent / 100};
}

double Mean(double a, double b) { return (a + b) / 2; }

/// Mid-hip to cervicale: the three parts of the trunk.
double CervicaleMm(const Table& table) {
  return At(table, Segment::kUpperTrunk).length_mm + At(table, Segment::kMiddleTrunk).length_mm +
         At(table, Segment::kLowerTrunk).length_mm;
}

double TrunkCentreMm(const Table& table, Segment part) {
  double top_mm = CervicaleMm(table);  // Upper end of the part, over mid-hip.
  for (Segment above : {Segment::kUpperTrunk, Segment::kMiddleTrunk}) {
    if (part == above) break;
    top_mm -= At(table, above).length_mm;
  }
  const Row& row = At(table, part);
  return top_mm - row.centre_percent / 100 * row.length_mm;
}

double LegMm(const Table& table) {
  return At(table, Segment::kThigh).length_mm + At(table, Segment::kShank).length_mm;
}

double OfSex(Sex sex, double female, double male) {
  if (sex == Sex::kFemale) return female;
  return sex == Sex::kMale ? male : Mean(female, male);
}

}  // namespace

SegmentParameters Parameters(Segment segment, Sex sex) {
  const SegmentParameters female = FromRow(kFemale, kFemaleStatureMm, segment);
  const SegmentParameters male = FromRow(kMale, kMaleStatureMm, segment);
  if (sex == Sex::kFemale) return female;
  if (sex == Sex::kMale) return male;
  return {male.name,
          Mean(female.length_of_stature, male.length_of_stature),
          Mean(female.mass_of_body, male.mass_of_body),
          Mean(female.centre_of_length, male.centre_of_length),
          Mean(female.sagittal_radius, male.sagittal_radius),
          Mean(female.transverse_radius, male.transverse_radius),
          Mean(female.longitudinal_radius, male.longitudinal_radius)};
}

double TrunkCentre(Segment trunk_part, Sex sex) {
  return OfSex(sex, TrunkCentreMm(kFemale, trunk_part) / kFemaleTrunkMm,
               TrunkCentreMm(kMale, trunk_part) / kMaleTrunkMm);
}

double CervicaleOnTrunk(Sex sex) {
  return OfSex(sex, CervicaleMm(kFemale) / kFemaleTrunkMm, CervicaleMm(kMale) / kMaleTrunkMm);
}

double StatureOfLengths(Sex sex) {
  return OfSex(sex, kFemaleStatureMm / (LegMm(kFemale) + kFemaleTrunkMm),
               kMaleStatureMm / (LegMm(kMale) + kMaleTrunkMm));
}

double TrunkOfStature(Sex sex) {
  return OfSex(sex, kFemaleTrunkMm / kFemaleStatureMm, kMaleTrunkMm / kMaleStatureMm);
}

}  // namespace footing::body
