//! `fault`: fault handlers: everything off, crash record kept and reported, restart
//! (docs/architecture.md §6.2). Backup registers of the chip: RM0433, 46.6.20.

stm32_kit::fault_handlers!(backup registers: 32, cause of the reset: rsr, iwdg1rstf);
