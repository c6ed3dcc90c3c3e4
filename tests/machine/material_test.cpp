#include "machine/material.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

using testing::HasSubstr;

TEST(Material, ShippedOnesAreTheReferences) {
  // docs/reference.md#cooling.
  const Material abs = load_material("abs"), pla = load_material("pla");
  EXPECT_EQ(abs.density, 1040);
  EXPECT_EQ(abs.specific_heat, 2080);
  EXPECT_DOUBLE_EQ(abs.youngs_modulus, 2.2e9);
  EXPECT_DOUBLE_EQ(abs.nozzle_temperature, 230 + 273.15);
  EXPECT_DOUBLE_EQ(abs.glass_transition, 105 + 273.15);
  EXPECT_EQ(abs.wlf_c1, 12.05);
  EXPECT_EQ(abs.wlf_c2, 51.6);
  EXPECT_EQ(pla.density, 1240);
  EXPECT_EQ(pla.specific_heat, 1800);
  EXPECT_DOUBLE_EQ(pla.youngs_modulus, 3.5e9);
  EXPECT_DOUBLE_EQ(pla.nozzle_temperature, 210 + 273.15);
  EXPECT_DOUBLE_EQ(pla.glass_transition, 60 + 273.15);
  EXPECT_EQ(pla.wlf_c1, 11.86);
  EXPECT_EQ(pla.wlf_c2, 51.6);
  for (const Material& m : {abs, pla}) EXPECT_EQ(m.emissivity, 0.9);
}

TEST(Material, EveryShippedFileLoadsUnderItsName) {
  EXPECT_THAT(material_names(), testing::IsSupersetOf({"abs", "pla"}));
  for (const std::string& name : material_names()) EXPECT_EQ(load_material(name).name, name);
}

TEST(Material, ViscosityIsThatOfWilliamsLandelAndFerry) {
  const Material abs = load_material("abs");
  EXPECT_NEAR(viscosity(abs, abs.glass_transition), 1e12, 1);
  // By hand, 125 K above: 12 - 12.05 * 125/176.6 = 3.47084.
  EXPECT_NEAR(viscosity(abs, abs.nozzle_temperature), std::pow(10, 3.470838), 0.02);
  EXPECT_EQ(viscosity(abs, abs.glass_transition - 1e-9), std::numeric_limits<double>::infinity());
  double before = std::numeric_limits<double>::infinity();
  for (double T = abs.glass_transition; T < 560; T += 1) {
    EXPECT_LT(viscosity(abs, T), before);
    before = viscosity(abs, T);
  }
}

TEST(Material, ExtrudingColdOrTooHotIsRefused) {
  const Material pla = load_material("pla");
  EXPECT_NO_THROW(check_nozzle_temperature(pla, pla.nozzle_temperature));
  try {
    check_nozzle_temperature(pla, kCelsiusZero + 25);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "nozzle temperature is 25.0 C, outside 180.0 to 240.0 C of material pla and not above its glass "
        "transition at 60.0 C");
  }
  EXPECT_THROW(check_nozzle_temperature(pla, kCelsiusZero + 300), InputError);
  EXPECT_THROW(check_nozzle_temperature(pla, NAN), InputError);
}

class MaterialFile : public testing::Test {
 protected:
  void SetUp() override {
    std::ifstream file(models_folder() / "materials" / "abs.yaml");
    std::ostringstream text;
    text << file.rdbuf();
    text_ = text.str();
  }

  std::string error_of(const std::string& from, const std::string& to) {
    std::string text = text_;
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    text.replace(place, from.size(), to);
    std::ofstream(path_) << text;
    try {
      load_material(path_.string());
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_THAT(what, HasSubstr(path_.filename().string() + ":"));
      EXPECT_EQ(what.find('\n'), std::string::npos);
      line_named_ = what.find(".yaml:" + std::to_string(line) + ":") != std::string::npos;
      return what;
    }
    return "accepted";
  }

  std::string text_;
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "material.yaml";
  bool line_named_ = false;
};

TEST_F(MaterialFile, AUsersFileIsReadByItsPath) {
  EXPECT_EQ(error_of("name: abs", "name: my own"), "accepted");
  EXPECT_EQ(load_material(path_.string()).name, "my own");
}

TEST_F(MaterialFile, MistakesNameFileLineValueAndLimit) {
  EXPECT_THAT(error_of("density_kg_per_m3: 1040", "density_kg_per_m3: -1"),
              HasSubstr("density_kg_per_m3 is -1 kg/m^3, outside 100 to 20000 kg/m^3"));
  EXPECT_TRUE(line_named_);
  EXPECT_THAT(error_of("emissivity: 0.9", "emissivity: 1.2"), HasSubstr("emissivity is 1.2, outside 0 to 1"));
  EXPECT_TRUE(line_named_);
  EXPECT_THAT(error_of("youngs_modulus_gpa: 2.2", "youngs_modulus_gpa: stiff"),
              HasSubstr("youngs_modulus_gpa is 'stiff', where a number in GPa is expected"));
  EXPECT_THAT(error_of("wlf_c2_k: 51.6", "wlf_c2_k: .nan"), HasSubstr("not finite"));
  EXPECT_THAT(error_of("wlf_c1:", "wfl_c1:"), HasSubstr("unknown key 'wfl_c1', did you mean 'wlf_c1'?"));
  EXPECT_TRUE(line_named_);
  EXPECT_THAT(error_of("emissivity: 0.9", ""), HasSubstr("key 'emissivity' is missing"));
  EXPECT_THAT(error_of("nozzle_min_c: 200", "nozzle_min_c: 100"),
              HasSubstr("nozzle_min_c is 100.0 C, not above the glass transition at 105.0 C"));
  EXPECT_TRUE(line_named_);
  EXPECT_THAT(error_of("nozzle_max_c: 270", "nozzle_max_c: 190"),
              HasSubstr("nozzle_max_c is 190.0 C, below nozzle_min_c of 200.0 C"));
  EXPECT_THAT(error_of("nozzle_c: 230", "nozzle_c: 280"), HasSubstr("nozzle_c is 280.0 C, outside"));
  EXPECT_TRUE(line_named_);
}

TEST(Material, AnUnknownOneNamesTheKnown) {
  const auto message = [](const std::string& name) -> std::string {
    try {
      load_material(name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("plaa"),
              HasSubstr("unknown material 'plaa', did you mean 'pla'?; known materials: abs, pla"));
  EXPECT_THAT(message("/nowhere/x.yaml"), HasSubstr("cannot read /nowhere/x.yaml: "));
  EXPECT_THAT(message(""), HasSubstr("no name"));
}

}  // namespace
}  // namespace understudy::machine
