/* What lasts when the power goes: the EEPROM, and the table in flash. */
#include <avr/eeprom.h>
#include <avr/pgmspace.h>

#include "hardware.h"
#include "target.h"

#ifdef HAS_FLASH_TABLE
#include "flash_table.h"
static const uint16_t ROWS[FLASH_TABLE_ROWS][FLASH_TABLE_JOINTS] PROGMEM = FLASH_TABLE;
#endif

static uint8_t memory[MEMORY_BYTES] EEMEM;

bool hardware_is_memory_ready(void)
{
    return eeprom_is_ready();
}

uint8_t hardware_read_memory(uint16_t address)
{
    return eeprom_read_byte(memory + address);
}

void hardware_write_memory(uint16_t address, uint8_t value)
{
    eeprom_update_byte(memory + address, value);
}

FlashTable hardware_flash_table(void)
{
#ifdef HAS_FLASH_TABLE
    return (FlashTable){FLASH_TABLE_ROWS, FLASH_TABLE_STEP_MS, FLASH_TABLE_LOOPS};
#else
    return (FlashTable){0};
#endif
}

uint16_t hardware_flash_count(uint16_t row, uint8_t joint)
{
#ifdef HAS_FLASH_TABLE
    uint32_t place = (uint32_t)row * FLASH_TABLE_JOINTS + joint;
    return pgm_read_word_far(pgm_get_far_address(ROWS) + 2 * place);
#else
    (void)row, (void)joint;
    return 0;
#endif
}
