// Reading takes no longer a byte where the file is longer.
#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/fuzz/reader.h"
#include "tests/fuzz/targets.h"

namespace understudy::fuzz {
namespace {

struct Case {
  const char* name;
  const char* reader;
  std::function<std::string(int size)> text;
  int size;  ///< for some milliseconds
};

std::string repeated(int times, const std::function<std::string(int)>& part) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part(i);
  return text;
}

std::string gcode(int n) {
  return "G1 F1000\n" + repeated(n, [](int i) { return fmt::format("G1 X{} Y{} E{}\n", i % 90, i % 70, i); });
}
std::string gcode_words(int n) {
  return "G1 X0 F1000\n" +
         repeated(n, [](int i) { return fmt::format("G0X{} ; {}\n", i % 10, std::string(60, 'x')); });
}
std::string gcode_one_line(int n) {
  return repeated(n, [](int) { return "M73 P1 "; });
}
std::string gcode_names(int n) {
  return "G1 X0 F1000\n" + repeated(n, [](int i) { return fmt::format("UNHEARD{}\n", i); });
}
std::string krl(int n) {
  return "DEF part( )\n$VEL.CP=0.02\n$OUT[1]=TRUE\n" +
         repeated(n,
                  [](int i) {
                    return fmt::format("LIN {{X {},Y {},Z 5,A 0,B 0,C 180}} C_DIS\n", i % 90, i % 70);
                  }) +
         "END\n";
}
std::string krl_names(int n) {
  return "DEF part( )\n" + repeated(n, [](int i) { return fmt::format("P{}={{X {}}}\n", i, i); }) +
         repeated(n, [](int i) { return fmt::format("UNHEARD{}\n", i); }) + "END\n";
}
std::string krl_blocks(int n) {
  return "DEF part( )\n" + repeated(n, [](int) { return "LOOP\n"; }) +
         repeated(n, [](int) { return "ENDLOOP\n"; }) + "END\n";
}
std::string rapid(int n) {
  return "MODULE m\nPROC main()\nSetDO d,1;\n" +
         repeated(n,
                  [](int i) {
                    return fmt::format(
                        "MoveL [[{},{},5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,t;\n", i % 90,
                        i % 70);
                  }) +
         "ENDPROC\nENDMODULE\n";
}
std::string rapid_array(int n) {
  return "MODULE m\nCONST robtarget p{2}:=[" +
         repeated(n, [](int i) { return fmt::format("{}{}", i > 0 ? "," : "", i % 10); }) +
         "];\nPROC main()\n" + repeated(n, [](int i) { return fmt::format("x:=p{{{}}};\n", i + 1); }) +
         "ENDPROC\nENDMODULE\n";
}
std::string facets(int n) {
  return "solid s\n" +
         repeated(n,
                  [](int i) {
                    const double x = 0.001 * i;
                    return fmt::format(
                        "facet normal 0 0 1\nouter loop\nvertex {} 0 0\nvertex {} 5 0\nvertex {} 0 "
                        "9\nendloop\nendfacet\n",
                        x, x, x + 1);
                  }) +
         "endsolid s\n";
}
std::string curve(int n) {
  return "x_mm,y_mm,z_mm\n" + repeated(n, [](int i) { return fmt::format("{},{},1\n", 0.1 * i, i % 7); });
}
std::string waypoints(int n) {
  return repeated(n, [](int i) {
    const int row = i / 500;
    return fmt::format("{} {} 1 0 0 1\n", 0.1 * (i % 500), 0.1 * row);
  });
}
std::string lattice(int n) {
  std::string nodes = R"({"X":0,"Y":0,"Z":0})", text = R"({"unit":"millimeter","node_list":[)";
  for (int i = 0; i <= n; ++i)
    text += fmt::format(R"({}{{"point":{{"X":{},"Y":0,"Z":0}},"is_grounded":{}}})", i > 0 ? "," : "", i,
                        i == 0 ? 1 : 0);
  text += R"(],"element_list":[)";
  for (int i = 0; i < n; ++i)
    text += fmt::format(R"({}{{"end_node_ids":[{},{}]}})", i > 0 ? "," : "", i, i + 1);
  return text + "]}";
}
std::string yaml_keys(int n) {
  return "name: pla\n" + repeated(n, [](int i) { return fmt::format("density_{}: [1, 2]\n", i); });
}
std::string yaml_list(int n) {
  return "name: x\nexpect:\n" +
         repeated(n, [](int) { return "  - {metric: verdict, equals: go, source: x}\n"; });
}
std::string links(int n) {
  return "<robot name=\"r\"><link name=\"base\"/><link name=\"tool\"/>" +
         repeated(n,
                  [](int i) {
                    return fmt::format("<material name=\"m{}\"><color rgba=\"0 0 0 1\"/></material>", i);
                  }) +
         "</robot>";
}
std::string gap_pictures(int n) {
  return "height_mm,picture,gap_mm,gap_sigma_um\n" + repeated(n, [](int i) {
           return fmt::format("{},p{}.png,{},1\n", 0.1 + 0.1 * (i % 10), i, 0.1 + 0.1 * (i % 10));
         });
}
std::string gap_flats(int n) {
  return "height_mm,picture,gap_mm,gap_sigma_um,tilt_deg,azimuth_deg\n" + repeated(n, [](int i) {
           return fmt::format("{},p{}.png,,,{},0\n", 0.1 + 0.1 * (i % 10), i, 1 + 1e-4 * i);
         });
}
std::string targets_table(int n) {
  return "picture,pose,camera,target,u_px,v_px,c11_px2,c12_px2,c22_px2,radius_px\n" +
         repeated(n, [](int i) { return fmt::format("a.png,{},0,0,1,1,1,0,1,9\n", i + 1); });
}
std::string answer(int n) {
  return R"({"schema":"understudy.calibration-answer/2","note":[)" +
         repeated(n, [](int i) { return fmt::format("{},", i); }) + "0]}";
}
std::string manifest(int n) {
  return repeated(n, [](int i) { return fmt::format("DIGEST  f{}\n", i); }) + "DIGEST  a\n";
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all{{"Gcode", "gcode", gcode, 500},
                                     {"GcodeShortLines", "gcode", gcode_words, 500},
                                     {"GcodeOneLine", "gcode", gcode_one_line, 1000},
                                     {"GcodeNames", "gcode", gcode_names, 300},
                                     {"Krl", "krl", krl, 200},
                                     {"KrlNames", "krl", krl_names, 200},
                                     {"KrlBlocks", "krl", krl_blocks, 500},
                                     {"Rapid", "rapid", rapid, 200},
                                     {"RapidArray", "rapid", rapid_array, 500},
                                     {"Stl", "stl", facets, 300},
                                     {"Curve", "curve", curve, 1000},
                                     {"Waypoints", "waypoints", waypoints, 500},
                                     {"Lattice", "lattice", lattice, 200},
                                     {"UnknownKeys", "material", yaml_keys, 100},
                                     {"ListOfMaps", "scenario", yaml_list, 100},
                                     {"UrdfMaterials", "urdf", links, 300},
                                     {"GapPictures", "picture_tables", gap_pictures, 500},
                                     {"GapFlats", "picture_tables", gap_flats, 500},
                                     {"Targets", "picture_tables", targets_table, 500},
                                     {"Answer", "plugin_answer", answer, 3000},
                                     {"Manifest", "manifest", manifest, 1000}};
  return all;
}

/// [s], the least of some, which other work on the machine disturbs least.
double reading_time(const Case& reading, int size) {
  const std::string text = reading.text(size);
  double least = 1e9;
  for (int i = 0; i < 3; ++i) {
    const double begin = processor_time();
    run(reading.reader, text);
    least = std::min(least, processor_time() - begin);
  }
  return least;
}

class ReadingTime : public ::testing::TestWithParam<Case> {};

TEST_P(ReadingTime, GrowsNoFasterThanTheFile) {
  constexpr int kTimes = 16;
  // Twice for memory that no longer fits the caches and for sorted tables; what is quadratic takes 256.
  constexpr double kFactor = 2.5 * kTimes;
  const double small = reading_time(GetParam(), GetParam().size);
  const double large = reading_time(GetParam(), kTimes * GetParam().size);
  EXPECT_LT(large, kFactor * small + 0.005) << small << " s, then " << large << " s";
}

INSTANTIATE_TEST_SUITE_P(Reader, ReadingTime, ::testing::ValuesIn(cases()),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace understudy::fuzz
