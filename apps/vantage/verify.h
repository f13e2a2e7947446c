// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/audit/certificate.h"
#include "vantage/session/result.h"

/// Exit code of `reconstruct --verify` when the certificate is wrong: 1, as programs that compare have it.
inline constexpr int kWrongCertificate = 1;

/// The `verify` object of `reconstruct --json`.
[[nodiscard]] vantage::Json to_json(const vantage::CertificateReport& report);
/// "verified: …" in two lines, and one a fault.
[[nodiscard]] std::string verify_text(const vantage::CertificateReport& report);
