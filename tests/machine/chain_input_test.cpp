// Mistakes in the files of open chains: one line with file, line, key, value and limit.
#include <filesystem>

#include "core/file/read_file.h"
#include "tests/machine/edited_file.h"
#include "tests/machine/scara.h"

namespace understudy::machine {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kModels = UNDERSTUDY_SOURCE_DIR "/models/";

class ChainInput : public EditedFile {
 protected:
  std::string scara(const std::string& after, const std::string& from, const std::string& to) {
    return error_of(edited(kScara, after, from, to));
  }
  std::string arm(const std::string& after, const std::string& from, const std::string& to) {
    return error_of(edited(read_file(kModels + "arm/machine.yaml"), after, from, to));
  }
};

TEST_F(ChainInput, ARangeThatEndsBeforeItBegins) {
  EXPECT_THAT(arm("- name: j2", "range_deg: [-45, 150]", "range_deg: [150, -45]"),
              AllOf(HasSubstr(kInThatLine),
                    HasSubstr("axes[2].range_deg begins at 150 and ends at -45 deg, not above it")));
  EXPECT_THAT(scara("- name: quill", "range_mm: [-105, 60]", "range_mm: [60, 60]"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("axes[4].range_mm begins at 60 and ends at 60 mm")));
}

// A stranger's machine file must not make us read the user's other files, and tell of them in a message.
TEST_F(ChainInput, AUrdfOutsideTheMachinesFolder) {
  std::filesystem::copy_file(kModels + "offset-wrist-arm/arm.urdf", folder_ / "arm.urdf");
  const std::string text = read_file(kModels + "offset-wrist-arm/machine.yaml");
  EXPECT_EQ(error_of(text), "accepted");
  for (const std::string& name : {std::string("../other/arm.urdf"), kModels + "offset-wrist-arm/arm.urdf"})
    EXPECT_THAT(error_of(edited(text, "geometry:", "arm.urdf", name)),
                AllOf(HasSubstr(kInThatLine), HasSubstr("outside the machine file's folder")))
        << name;
}

TEST_F(ChainInput, AHomeOutsideItsRange) {
  EXPECT_THAT(arm("- name: j3", "home_deg: 15", "home_deg: 71"),
              AllOf(HasSubstr(kInThatLine),
                    HasSubstr("axes[3].home_deg is 71 deg, outside the axis' range of -190 to 70")));
  EXPECT_THAT(scara("- name: quill", "home_mm: -50", "home_mm: 61"),
              HasSubstr("axes[4].home_mm is 61 mm, outside the axis' range of -105 to 60"));
}

TEST_F(ChainInput, AxesThatCoincide) {
  EXPECT_THAT(scara("- name: elbow", "point_mm: [200, 0, 300]", "point_mm: [0, 0, 250]"),
              HasSubstr("axes shoulder and elbow coincide: their lines are 0.0000 mm apart"));
  // The other way along the same line is the same line.
  auto text = edited(kScara, "- name: elbow", "point_mm: [200, 0, 300]", "point_mm: [0, 0, 250]");
  text = edited(text, "- name: elbow", "direction: [0, 0, 1]", "direction: [0, 0, -1]");
  EXPECT_THAT(error_of(text), HasSubstr("coincide"));
  // Parallel, but 0.01 mm apart: two axes, if badly placed ones.
  EXPECT_EQ(scara("- name: elbow", "point_mm: [200, 0, 300]", "point_mm: [0.01, 0, 300]"), "accepted");
}

TEST_F(ChainInput, NegativePlayAndFriction) {
  EXPECT_THAT(arm("- name: j1", "play_arcmin: 0.36", "play_arcmin: -0.36"),
              AllOf(HasSubstr(kInThatLine),
                    HasSubstr("axes[1].play_arcmin is -0.36 arcmin, outside 0 to 600 arcmin")));
  EXPECT_THAT(scara("- name: quill", "play_um: 20", "play_um: -20"),
              HasSubstr("axes[4].play_um is -20 um, outside 0 to 2000 um"));
  EXPECT_THAT(scara("- name: elbow", "friction_newton_metre: 0.1", "friction_newton_metre: -0.1"),
              HasSubstr("axes[2].friction_newton_metre is -0.1 N m, outside 0 to 1000 N m"));
}

TEST_F(ChainInput, AxesOfAnotherNumberOrName) {
  EXPECT_THAT(
      arm("- name: j6", "name: j6", "name: j7"),
      AllOf(HasSubstr(kInThatLine), HasSubstr("axes[6].name is 'j7', where axis 6 of 'arm' is 'j6'")));
  std::string five = read_file(kModels + "arm/machine.yaml");
  const auto begin = five.find("  - name: j6"), end = five.find("\ntool:");
  const std::string last = five.substr(begin, end - begin);
  five.erase(begin, end - begin);
  EXPECT_THAT(error_of(five), HasSubstr("axes lists 5, 'arm' has 6"));
  std::string seven = read_file(kModels + "arm/machine.yaml");
  seven.insert(seven.find("\ntool:"), last);
  EXPECT_THAT(error_of(seven), HasSubstr("7 axes are given, 'arm' has 6"));
}

TEST_F(ChainInput, MoreAxesThanAnyMachineHas) {
  std::string text = kScara;
  const auto begin = text.find("  - name: quill"), end = text.find("tool:\n", begin);
  const std::string quill = text.substr(begin, end - begin);
  std::string more;
  for (int i = 0; i < 5; ++i) {
    std::string axis = quill;
    axis.replace(axis.find("name: quill"), 11, "name: quill" + std::to_string(i));
    more += axis;
  }
  text.insert(end, more);
  EXPECT_THAT(error_of(text), HasSubstr("more than 8 axes"));
}

TEST_F(ChainInput, UnknownKeysNameTheNearest) {
  EXPECT_THAT(arm("- name: j2", "play_arcmin", "play_arcmins"),
              AllOf(HasSubstr(kInThatLine),
                    HasSubstr("unknown key 'axes[2].play_arcmins', did you mean 'play_arcmin'?")));
  EXPECT_THAT(arm("geometry", "d4_mm", "d5_mm"),
              HasSubstr("unknown key 'geometry.d5_mm', did you mean 'd4_mm'?"));
  EXPECT_THAT(scara("- name: quill", "play_um: 20", "play_arcmin: 20"),
              HasSubstr("unknown key 'axes[4].play_arcmin'"));
  EXPECT_THAT(scara("- name: quill", "carried_by: wrist", "carried_by: wrist\n    point_mm: [0, 0, 0]"),
              HasSubstr("unknown key 'axes[4].point_mm'"));  // a slide has no line
  EXPECT_THAT(scara("- name: quill", "mass_kg", "mass_g"),
              HasSubstr("unknown key 'axes[4].link.mass_g', did you mean 'mass_kg'?"));
}

TEST_F(ChainInput, MetresUnderAMillimetreKey) {
  EXPECT_THAT(
      scara("- name: quill", "lead_mm: 8", "lead_mm: 0.008"),
      AllOf(HasSubstr(kInThatLine), HasSubstr("axes[4].drive.lead_mm is 0.008 mm, outside 0.1 to 100 mm")));
  EXPECT_THAT(scara("conditioning", "length_scale_mm: 200", "length_scale_mm: 0.2"),
              HasSubstr("conditioning.length_scale_mm is 0.2 mm, outside 1 to 5000 mm"));
}

TEST_F(ChainInput, ADirectionThatIsNone) {
  EXPECT_THAT(scara("- name: elbow", "direction: [0, 0, 1]", "direction: [0, 0, 0]"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("axes[2].direction has length 0: no direction")));
  EXPECT_THAT(scara("geometry", "tool_direction: [0, 0, 1]", "tool_direction: [0, 0, 0]"),
              HasSubstr("geometry.tool_direction has length 0"));
}

TEST_F(ChainInput, CarriedByNobodyOrByWhatComesLater) {
  EXPECT_THAT(scara("- name: wrist", "carried_by: elbow", "carried_by: ellbow"),
              AllOf(HasSubstr(kInThatLine),
                    HasSubstr("axes[3].carried_by is 'ellbow', not one of frame, shoulder, elbow")));
  EXPECT_THAT(scara("- name: shoulder", "carried_by: frame", "carried_by: elbow"),
              HasSubstr("axes[1].carried_by is 'elbow', not one of frame"));
  EXPECT_THAT(
      scara("geometry", "tool_carried_by: quill", "tool_carried_by: quil"),
      AllOf(HasSubstr("geometry.tool_carried_by is 'quil', not one of frame, shoulder, elbow, wrist, quill"),
            HasSubstr(kInThatLine)));
  EXPECT_THAT(scara("geometry", "work_carried_by: frame", "work_carried_by: table"),
              HasSubstr("geometry.work_carried_by is 'table'"));
}

TEST_F(ChainInput, AnAxisThatMovesNeitherToolNorWork) {
  EXPECT_THAT(
      scara("- name: quill", "carried_by: wrist", "carried_by: elbow"),
      AllOf(HasSubstr("machine.yaml:35:"), HasSubstr("axis wrist carries neither the tool nor the work")));
  EXPECT_THAT(scara("geometry", "tool_carried_by: quill", "tool_carried_by: wrist"),
              HasSubstr("axis quill carries neither the tool nor the work"));
  auto both = edited(kScara, "geometry", "tool_carried_by: quill", "tool_carried_by: elbow");
  both = edited(both, "- name: wrist", "carried_by: elbow", "carried_by: frame");
  both = edited(both, "geometry", "  base_mm: [-250, 0, 0]\n  base_turn_deg: 0\n", "");
  EXPECT_EQ(error_of(edited(both, "geometry", "work_carried_by: frame", "work_carried_by: quill")),
            "accepted");
}

TEST_F(ChainInput, TwoAxesOfOneNameAndNamesThatMeanSomethingElse) {
  EXPECT_THAT(scara("- name: elbow", "name: elbow", "name: shoulder"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("axes[2].name is 'shoulder', as axis 1 is")));
  EXPECT_THAT(scara("- name: shoulder", "name: shoulder", "name: frame"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("axes[1].name is 'frame'")));
  EXPECT_THAT(scara("- name: shoulder", "name: shoulder", "name: 'a\"b<c'"), HasSubstr("axes[1].name is"));
}

TEST_F(ChainInput, AnInertiaThatNoBodyHas) {
  EXPECT_THAT(scara("- name: wrist", "inertia_kg_mm2: [100, 100, 100]", "inertia_kg_mm2: [100, 100, 201]"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("axes[3].link.inertia_kg_mm2"), HasSubstr("201"),
                    HasSubstr("more than the sum 200 kg mm^2")));
  EXPECT_THAT(scara("- name: wrist", "mass_kg: 0.3", "mass_kg: 0"),
              HasSubstr("axes[3].link.mass_kg is 0 kg, outside"));
}

TEST_F(ChainInput, MissingKeys) {
  const std::string drive =
      "    drive: {lead_mm: 8, steps_per_turn: 200, microsteps: 16, velocity_max_mm_per_s: 100, "
      "acceleration_max_mm_per_s2: 2000, self_locking: yes}\n";
  EXPECT_THAT(scara("- name: quill", drive, ""), HasSubstr("key 'axes[4].drive' is missing"));
  EXPECT_THAT(scara("- name: quill", "    play_um: 20\n", ""), HasSubstr("key 'axes[4].play_um' is missing"));
  EXPECT_THAT(scara("conditioning", "  length_scale_mm: 200\n", "  condition_max: 100\n"),
              HasSubstr("key 'conditioning.length_scale_mm' is missing"));
  EXPECT_THAT(arm("geometry", "  d6_mm: 90\n", ""), HasSubstr("key 'geometry.d6_mm' is missing"));
}

TEST_F(ChainInput, AnElasticDriveIsToldWhole) {
  const auto elastic = [&](const std::string& keys) {
    return scara("- name: quill", "microsteps: 16,", "microsteps: 16, " + keys);
  };
  EXPECT_THAT(elastic("stiffness_n_per_um: 20, damping_ratio: 0.1,"),
              HasSubstr("key 'axes[4].drive.resonance_hz' is missing"));
  EXPECT_THAT(elastic("stiffness_n_per_um: 20, resonance_hz: 200,"),
              HasSubstr("key 'axes[4].drive.damping_ratio' is missing"));
  EXPECT_THAT(elastic("resonance_hz: 200, damping_ratio: 0.1,"), HasSubstr("unknown key 'axes[4].drive."));
  EXPECT_THAT(elastic("stiffness_n_per_um: -20, resonance_hz: 200, damping_ratio: 0.1,"),
              HasSubstr("stiffness_n_per_um is -20 N/um, outside 0.01 to 100000 N/um"));
  EXPECT_THAT(elastic("stiffness_nm_per_rad: 20, resonance_hz: 200, damping_ratio: 0.1,"),
              HasSubstr("unknown key 'axes[4].drive."));  // of an axis that turns
  EXPECT_THAT(elastic("stiffness_n_per_um: 20, resonance_hz: 0, damping_ratio: 0.1,"),
              HasSubstr("resonance_hz is 0 Hz, outside 1 to 2000 Hz"));
}

TEST_F(ChainInput, WordsThatAreNone) {
  EXPECT_THAT(scara("- name: quill", "moves: slides", "moves: glides"),
              HasSubstr("axes[4].moves is 'glides', not one of turns, slides"));
  EXPECT_THAT(scara("- name: quill", "self_locking: yes", "self_locking: maybe"),
              HasSubstr("axes[4].drive.self_locking is 'maybe', not one of yes, no"));
}

// What the hexapod's own tests leave out: limits that contradict each other, a loop that home cannot close.
class HexapodInput : public EditedFile {
 protected:
  std::string hexapod(const std::string& after, const std::string& from, const std::string& to) {
    return error_of(edited(read_file(kModels + "hexapod/machine.yaml"), after, from, to));
  }
};

TEST_F(HexapodInput, JointLimitsThatContradictEachOther) {
  EXPECT_THAT(
      hexapod("limits", "base_joint_alpha_min_deg: -30", "base_joint_alpha_min_deg: 46"),
      AllOf(HasSubstr("limits.base_joint_alpha_min_deg is 46"), HasSubstr("base_joint_alpha_max_deg")));
  EXPECT_THAT(hexapod("limits", "ball_joint_min_deg: 60", "ball_joint_min_deg: 120"),
              AllOf(HasSubstr("limits.ball_joint_min_deg is 120"), HasSubstr("ball_joint_max_deg")));
}

TEST_F(HexapodInput, AHomeWhoseLoopsCannotBeAssembled) {
  // The deviation is longer than the strut that it is a leg of.
  EXPECT_THAT(hexapod("geometry", "deviation_mm: 15", "deviation_mm: 200"),
              AllOf(HasSubstr("has no length at home"), HasSubstr("the deviation is 200 mm")));
  EXPECT_THAT(hexapod("play", "ball_joint_um: 25", "ball_joint_um: -25"),
              HasSubstr("play.ball_joint_um is -25 um, outside 0 to 2000 um"));
}

}  // namespace
}  // namespace understudy::machine
