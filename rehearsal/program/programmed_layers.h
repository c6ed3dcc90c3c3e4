// How high over what is below each line of a program is meant to lie.
#pragma once

#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/deposition/gap_band.h"
#include "toolpath/inspection/told_beads.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// Of its cross-section, by which a bead may differ from the told one and still be it.
constexpr double kSameBead = 0.2;

/// The program laid on the part as drawn, or on a flat table, by a machine without errors: what the program
/// means, whatever the twin then does. A line's layer is the tenth percentile of the gaps over 50 mm of path
/// about it, so that a line over a hollow has the layer of those beside it. Where layers are wedges, a line
/// with more filament lies higher: its layer is as high as its own gap, as far as its filament is enough for
/// the width of the stretch's beads.
class ProgrammedLayers {
 public:
  /// The part may be null. `told` [m]: the layer of lines whose path does not tell one; 0: the machine's
  /// band.
  /// `beads`: what comments tell line by line. A line has the layer that is told where its filament makes the
  /// bead that is told, within kSameBead; in a program that prints supports, where it does not lie higher.
  ProgrammedLayers(const toolpath::Program& program, const machine::MachineDescription& machine,
                   const std::shared_ptr<const geometry::Mesh>& part, double told = 0,
                   const toolpath::ToldBeads& beads = {});

  /// The band of gaps that is good on this line of the file; the machine's own where it has no layer.
  sim::GapBand band(int line) const;
  /// [m], that the line is meant to lie over what is below; 0: none.
  double layer(int line) const;
  /// The band over most of the path.
  sim::GapBand typical_band() const;
  /// [m], median over the path; 0: nothing is printed on anything.
  double typical_layer() const { return static_cast<double>(typical_.layer); }

 private:
  struct Layer {
    float layer = 0;  // [m]; 0: none
    float area = 0;   // [m^2]
  };
  sim::GapBand told_band() const;

  struct Sample;
  struct Stretch;
  static Stretch close(std::vector<Sample>& samples);
  void assign(const Stretch& stretch);
  void take_told(const toolpath::ToldBeads& beads, const std::vector<float>& areas);
  void carry_on(const toolpath::Program& program);
  static Layer typical(const std::vector<Stretch>& stretches);

  machine::GapLimits limits_;
  std::vector<Layer> layers_;  // by line
  Layer typical_;
  double told_, told_area_ = 0;  // [m], [m^2]
};

}  // namespace understudy::rehearsal
