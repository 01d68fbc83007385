#pragma once

#include "esi/accumulator_config.h"
#include "esi/complementary_filter_config.h"
#include "esi/double_integral_config.h"
#include "esi/esi_config.h"
#include "esi/esi_net_config.h"
#include "esi/htac_config.h"
#include "esi/network_config.h"

namespace nightjar::esi {

enum class Method { esi, accumulator, complementary_filter, edi, fedi, htac, firenet, e2vid, esi_net };

inline constexpr core::Choices<Method, 9> kMethods{
    {{"esi", Method::esi},
     {"accumulator", Method::accumulator},
     {"complementary_filter", Method::complementary_filter},
     {"edi", Method::edi},
     {"fedi", Method::fedi},
     {"htac", Method::htac},
     {"firenet", Method::firenet},
     {"e2vid", Method::e2vid},
     {"esi_net", Method::esi_net}}};

/// Which method makes the pictures, and what each would do.
struct ReconstructorConfig {
  Method method = Method::esi;
  EsiConfig esi;
  AccumulatorConfig accumulator;
  ComplementaryFilterConfig complementary_filter;
  DoubleIntegralConfig edi;
  DoubleIntegralConfig fedi;
  HtacConfig htac;
  NetworkConfig firenet;
  NetworkConfig e2vid;
  EsiNetConfig esi_net;

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("method", method, kMethods);
    v.section("esi", esi);
    v.section("accumulator", accumulator);
    v.section("complementary_filter", complementary_filter);
    v.section("edi", edi);
    v.section("fedi", fedi);
    v.section("htac", htac);
    v.section("firenet", firenet);
    v.section("e2vid", e2vid);
    v.section("esi_net", esi_net);
  }
};

}  // namespace nightjar::esi
