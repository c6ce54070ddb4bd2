// Asks a Modbus server with the npm package modbus-serial: a JSON request as argument, JSON answers on stdout.
// {"tcp": port} or {"rtu": path}, "unit", "calls": [[method, ...arguments], ...]
const ModbusRTU = require("modbus-serial");

async function call(client, [method, ...given]) {
  try {
    const answer = await client[method](...given);
    return { data: answer.data ?? answer };
  } catch (error) {
    return { exception: error.modbusCode ?? String(error.message) };
  }
}

async function main(asked) {
  const client = new ModbusRTU();
  if (asked.tcp) await client.connectTCP("127.0.0.1", { port: asked.tcp });
  else await client.connectRTUBuffered(asked.rtu, { baudRate: 19200, parity: "none" });
  client.setID(asked.unit);
  client.setTimeout(3000);
  const answers = [];
  for (const one of asked.calls) answers.push(await call(client, one));
  await new Promise((done) => client.close(done));
  process.stdout.write(JSON.stringify(answers));
}

main(JSON.parse(process.argv[2])).catch((error) => {
  process.stderr.write(String(error.stack));
  process.exit(1);
});
