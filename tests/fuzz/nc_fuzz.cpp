// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include "fuzz/fuzz_targets.hpp"
#include "fuzz/read_all.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/nc/nc_reader.hpp"

namespace meridian::fuzz {
namespace {

cl::ClReaderOptions options_of_nc(cl::Dialect dialect) {
  const MachineModel model =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  cl::ClReaderOptions options;
  options.dialect = dialect;
  options.nc = nc::reader_of_programs(model, ToolTable({{1, 110, 5}}));
  return options;
}

}  // namespace

void read_nc(Bytes bytes) {
  static const std::array kOptions = {options_of_nc(cl::Dialect::kFanuc),
                                      options_of_nc(cl::Dialect::kSiemens),
                                      options_of_nc(cl::Dialect::kHeidenhain)};
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const cl::ClReaderOptions& options : kOptions) {
    cl::ClReader reader(text, "fuzz", options);
    read_all(reader);
  }
}

Seeds nc_seeds() {
  constexpr std::string_view kPrograms[] = {
      "%\nO0001 (A)\nG17 G21 G40 G49 G80 G90 G94\nG54\nG91 G28 Z0.\nG90\nT1 M6\nS6000 M3\nM8\n"
      "G0 A0. C0.\nG0 X10. Y20.\nG43.4 H1\nG0 X10. Y20. Z60.\nG1 Z50. F600.\n"
      "G1 X30. A30. C90.\nG4 X0.5\nG49\nG91 G28 Z0.\nG90 G53 G0 Z-1.\nM5\nM9\nM30\n%\n",
      "G20 G90\nG43.5 H1\nG0 X0. Y0. Z2. I0. J0. K1.\nG93 G1 X1. I0. J-.6 K.8 F30.\n"
      "/G94 G1 X2. F10. ; on\nG95 S100 M3\nG1 X3. F.01\nM1\nM2\n",
      "%\nG21\nG0 X10. Y0. Z0.\nG2 X0. Y10. I-10. J0. F100\nG3 X10. Y0. R-10. Z5.\nG18 G2 I-5.\n"
      "G19 G3 Y5. R20.\nG91 G1 X1 Y1\nN10 M88\nG65 P1 A#2\nIF [#1] GOTO 5\n%\n",
      "%\nO2\nG21 G90 F100.\nG0 X0. Y0. Z10.\nG98 G81 Z-10. R2.\nX5.\nG99 G83 X9. Z-20. R1. Q5.\n"
      "G91 G82 X1. Z-3. R-1. P200\nG80\nG90 G73 Q1. Z-5. R0. K0\nS9 M3\nG86 Y4.\nG89 Y5. "
      "P1.\nM30\n%\n",
      "%_N_A_MPF\n;$PATH=/_N_MPF_DIR\nTRAFOOF\nG17 G710 G40 G90 G94\nG54\nSUPA G0 Z0 D0\nT1\nM6\n"
      "S6000 M3\nG0 C0 A0\nG0 X10 Y20\nD1\nTRAORI(1)\nORIWKS ORIVECT\nG0 X10 Y20 Z=60 A3=0 B3=0 "
      "C3=1\nG1 Z=IC(-5) F600\nG1 X30 B3=-.6 C3=.8\nG4 F0.5\nG4 S3\nORIAXES\nG1 A30 C=90\n"
      "MSG(\"A;(B\")\nG3 X0 Y10 CR=30\nG2 X1 Y1 I=AC(2) J3 TURN=2\nTRAFOOF\nM1=5\nT=\"2\"\nR1=5\n"
      "IF R1 GOTOF A\nM30\n",
      "0 BEGIN PGM A MM\n1 ; NOTE\n2 FUNCTION RESET TCPM\n3 L Z+0 R0 FMAX M91\n4 TOOL CALL 1 Z "
      "S500\n"
      "5 M13\n6 L C+0 A+10 R0 FMAX\n7 L X+1 Y+2 R0 FMAX\n8 FUNCTION TCPM F TCP AXIS POS PATHCTRL "
      "VECTOR\n9 LN X+1 Y+2 Z+60 TX+0 TY+0 TZ+1 FMAX\n10 LN X+3 Y+2,5 Z+50 TX+0 TY-0.6 TZ+0.8 "
      "F600\n"
      "11 CYCL DEF 9.0 DWELL TIME\n12 CYCL DEF 9.1 DWELL 0.500\n13 M128\n14 L IX+10 A+30 C 90\n"
      "15 CC X+0 Y+0\n16 C X+0 Y+10 DR+\n17 CR X+0 Y-10 R-10 DR-\n18 M129\n19 L X+Q1\n20 STOP M9\n"
      "21 M30\n22 END PGM A MM\n",
      "%\nO3\nG21 G90 F100.\nG43 H1\nG52 X1.\nG68.2 X10. Y20. Z30. I90. J45. K-5.\nG53.1\nG0 X1. "
      "Y0. Z5.\nG1 Z0.\nG3 X0. Y10. R10.\nG81 X3. Y4. Z-2. R1.\nG69\nG91 G28 Z0.\nG90 G0 A0. "
      "C0.\nG234 H1\nG1 X1. A5.\nM30\n%\n",
      "%_N_B_MPF\nDEF REAL _X=-2.5, _Y\n_Y=5 R1=-_X\nT=\"MILL\" M6\nG0 X=_X Y=_Y Z=R1\nTRANS X10\n"
      "AROT Z90\nROT RPL=30\nATRANS Y-1\nG1 X1 F=R1\nTRANS\nCYCLE800(0,\"A\",1,57,1,2,3,0,45,0,0,0,"
      "1,-1)\nG0 X0 Y0 Z5\nG1 Z-1\nMIRROR\nCYCLE800()\nT0 M6\nM30\n",
      "0 BEGIN PGM B MM\n1 TOOL CALL \"MILL\" Z S500\n2 CYCL DEF 7.0 DATUM SHIFT\n3 CYCL DEF 7.1 "
      "X+10\n4 CYCL DEF 7.2 IY 2,5\n5 PLANE SPATIAL SPA+0 SPB+45,5 SPC-10 STAY\n6 L B+Q121 C+Q122 "
      "R0 FMAX\n7 L X+0 Y+0 Z+5 FMAX\n8 L Z+0 F600\n9 PLANE RESET TURN FMAX\n10 M30\n",
      "%\nO4\nG21 G90 F100.\nG43 H1\nG68.2 P2 Q1 X1. Y2. Z3.\nG68.2 P2 Q2 X9. Y2. Z3.\nG68.2 P2 Q3 "
      "X1. Y9. Z5.\nG53.1\nG0 X0. Y0. Z5.\nG1 Z0.\nG69\nG68.2 P3 Q1 X0. I1. J0. K0.\nG68.2 P3 Q2 "
      "K1.\nG53.1\nG0 X0. Y0. Z5.\nG69\nG68.2 P1 Q321 K45.\nG54.2 P0\nG15\nG55\nG54\nM30\n%\n",
      "0 BEGIN PGM C MM\n1 TOOL CALL 1 Z S500\n2 CYCL DEF 19.0 PLANE\n3 CYCL DEF 19.1 A+0\n4 TRANS "
      "DATUM AXIS X+1 Y 2\n5 CYCL DEF 10.1 ROT+0\n6 L X+10 Y+0 Z+5 FMAX M120 LA5\n7 CC X+0 Y+0\n8 "
      "CP IPA+810 IZ-4 DR+ F600\n9 CP PA+90 DR-\n10 L M140 MB5\n11 L M140 MB MAX\n12 M128 "
      "F5000\n13 "
      "L C+370\n14 L M94\n15 TRANS DATUM RESET\n16 FUNCTION MODE MILL\n17 M30\n",
      "%_N_C_MPF\nSTART:\nR5=3 CTOL=0.01 FGREF[C]=R5 ACC[X]=80\nG642 ADIS=0.05\nG500\nSUPA G0 Z0 "
      "D0\nG54\nG0 X0 Y0 Z9\nG1 X1 F9\nM30\n"};
  Seeds seeds;
  for (const std::string_view program : kPrograms) {
    seeds.emplace_back(program.begin(), program.end());
  }
  return seeds;
}

}  // namespace meridian::fuzz
