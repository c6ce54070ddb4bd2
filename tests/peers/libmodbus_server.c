/* A Modbus server made with libmodbus, for our master to ask: `tcp PORT` or `rtu PATH`, unit 17, 200 holding
   registers of which number n holds 3 n + 1 until it is written. */
#include <errno.h>
#include <modbus.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { UNIT = 17, REGISTERS = 200 };

static void serve(modbus_t *context, modbus_mapping_t *mapping)
{
    uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
    for (;;) {
        int length = modbus_receive(context, request);
        if (length > 0)
            modbus_reply(context, request, length, mapping);
        else if (length < 0 && errno != EMBBADCRC && errno != ETIMEDOUT)
            return;
    }
}

int main(int count, char **arguments)
{
    if (count != 3)
        return 2;
    int tcp = strcmp(arguments[1], "tcp") == 0;
    modbus_t *context = tcp ? modbus_new_tcp("127.0.0.1", atoi(arguments[2]))
                            : modbus_new_rtu(arguments[2], 19200, 'N', 8, 1);
    modbus_mapping_t *mapping = modbus_mapping_new(0, 0, REGISTERS, 0);
    if (context == NULL || mapping == NULL)
        return 1;
    for (int number = 0; number < REGISTERS; number++)
        mapping->tab_registers[number] = (uint16_t)(3 * number + 1);
    modbus_set_slave(context, UNIT);
    int listening = tcp ? modbus_tcp_listen(context, 1) : modbus_connect(context);
    if (listening < 0) {
        fprintf(stderr, "%s\n", modbus_strerror(errno));
        return 1;
    }
    puts("ready");
    fflush(stdout);
    do {
        if (tcp && modbus_tcp_accept(context, &listening) < 0)
            return 1;
        serve(context, mapping);
    } while (tcp);
    return 0;
}
