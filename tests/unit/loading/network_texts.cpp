#include <fmt/format.h>

#include "motion_texts.h"

namespace keyblock::loading {

std::string cwa_text() {
  std::string text =
      "#Earthquake Information\n#Origin Time(GMT+08): 2020/01/01-00:00:00\n#Depth(km): 10.0\n\n#StationCode: "
      "XXX\n"
      "#RecordLength(sec): 0.04\n#SampleRate(Hz): 100\n#AmplitudeUnit:  gal. DCoffset(corr)\n#AmplitudeMAX. "
      "U:    0.5~   -0.5\n"
      "#DataSequence: Time U(+); N(+); E(+)\n#Data: 4F10.3\n";
  for (int k = 0; k < 4; ++k)
    text += fmt::format("{:10.3f}{:10.3f}{:10.3f}{:10.3f}\n", 0.01 * k, 2.0 * k, 6.0 * k, 3.0 * k);
  return text;
}

std::string usc_text() {
  std::string text;
  for (const int direction : {90, 600}) {
    text += "FILE 1 OF UNCORRECTED ACCELEROGRAM DATA OF A FILM\n";
    for (int k = 1; k < 13; ++k) text += fmt::format("{:<72}{:2d}\n", "TEXT", 4);
    for (int k = 0; k < 112; ++k) {
      const int value = k == 26 ? direction : k == 27 ? 12 : 0;
      text += fmt::format("{:5d}{}", value, k % 16 == 15 ? "\n" : "");
    }
    for (int k = 0; k < 56; ++k) {
      const double value = k == 2 ? 0.22 : k == 4 ? 0.1 : 0.0;
      text += fmt::format("{:10.4f}{}", value, k % 8 == 7 ? "\n" : "");
    }
    for (int k = 0; k < 12; ++k)
      text += fmt::format("{:{}.3f}{:7.3f}{}", 0.02 * k, k % 5 == 0 ? 8 : 7, 1.0 * k,
                          k % 5 == 4 || k == 11 ? "\n" : "");
    text += "END OF RECORD\n";
  }
  return text;
}

std::string bhrc_text() {
  std::string text;
  for (const char* component : {"L", "V"}) {
    text += "* VOL1DS : 1234 / 01\nINSTR = SMA-1\n3\n4\n";
    text += fmt::format(
        "{}\n6\nCOMP\nSomewhere Station 35.70 51.40 1200 35.0 125.0\n9\nPERIOD 0.04 DAMPING 0.6\n",
        component);
    text += "NO OF POINTS 21 DURATION 0.100\n12\n13\n";
    for (int k = 0; k < 14; ++k) text += "    0    0\n";
    for (int k = 0; k < 21; ++k)
      text += fmt::format("{:13.6f}{}", 0.1 * k, k % 10 == 9 || k == 20 ? "\n" : "");
    text += "END OF RECORD\n";
  }
  return text;
}

std::string unam_text() {
  std::string text = "\n\n\n\n\n\nARCHIVO ESTANDAR DE ACELERACION\n\n";
  text += "NOMBRE DE LA ESTACION                  : NINGUNA PARTE\n";
  text += "FECHA DEL SISMO [GMT]                  : 2020/01/01\n";
  text += "ORIENTACION C1-C6 (rumbo;orientacion)  : /S00E;1/+V;2/N90W;3\n";
  text += "INTERVALO DE MUESTREO, C1-C6 (s)       : /0.005/0.005/0.005\n";
  text += "NUM. TOTAL DE MUESTRAS, C1-C6          : /6/6/6\n";
  text += "ACEL. MAX.(Gal), C1-C6                 : /5.0/10.0/-5.0\n";
  text += "COMENTARIOS\n\n      C1      C2      C3\n";
  for (int k = 0; k < 6; ++k) text += fmt::format("{:8.2f}{:8.2f}{:8.2f}\n", 1.0 * k, 2.0 * k, -1.0 * k);
  return text;
}

}  // namespace keyblock::loading
