#pragma once

#include <cstdint>
#include <string>

#include "common/recording/records.h"

/// Values to record bytes. Each appends one whole record, head included.
namespace footing::mcap {

void Encode(const Header& record, std::string& out);
void Encode(const Schema& record, std::string& out);
void Encode(const Channel& record, std::string& out);
void Encode(const Message& record, std::string& out);
void Encode(const Chunk& record, std::string& out);
void Encode(const MessageIndex& record, std::string& out);
void Encode(const ChunkIndex& record, std::string& out);
/// Appends the CRC-32 of its fields too.
void Encode(const Attachment& record, std::string& out);
void Encode(const AttachmentIndex& record, std::string& out);
void Encode(const Metadata& record, std::string& out);
void Encode(const MetadataIndex& record, std::string& out);
void Encode(const Statistics& record, std::string& out);
void Encode(const SummaryOffset& record, std::string& out);
/// `summary` is the file's bytes from the summary's start to here: the footer's CRC covers them and
/// its own first fields, so the record's own summary_crc is not looked at.
void EncodeFooter(const Footer& record, std::string_view summary, std::string& out);
void EncodeDataEnd(std::uint32_t data_section_crc, std::string& out);

}  // namespace footing::mcap
